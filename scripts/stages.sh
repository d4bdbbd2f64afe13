# The stages of scripts/test. Sourced in the root of the repository.
jobs=$(nproc)
passed=0
failed=0
skipped=0
table=()
counted=0 # whether the stage has counted its tests itself

# Runs a stage, keeps its time (elapsed, and of all processors) and counts it as one test unless it counts its own.
stage() { # <name> <command>...
  local name=$1 status=0 times result=passed
  shift
  printf '\n== %s\n' "$name"
  counted=0
  times=$(mktemp)
  local TIMEFORMAT='%0R %0U %0S'
  { time "$@" 2>&3 </dev/null; } 3>&2 2>"$times" || status=$?
  local elapsed user system
  read -r elapsed user system < <(tail -n 1 "$times")
  rm -f "$times"
  if [ "$status" -ne 0 ]; then
    result=FAILED
    [ "$counted" -eq 1 ] || failed=$((failed + 1))
  elif [ "$counted" -eq 0 ]; then
    passed=$((passed + 1))
  fi
  table+=("$(printf '%-12s %8s s %8s s  %s' "$name" "$elapsed" $((user + system)) "$result")")
  return "$status"
}

finish() {
  printf '\n%-12s %10s %10s\n' stage elapsed CPU
  printf '%s\n' "${table[@]}"
  local summary="$passed passed, $failed failed"
  [ "$skipped" -eq 0 ] || summary+=", $skipped skipped"
  echo "$summary"
  [ "$failed" -eq 0 ]
  exit
}

configure() { # <preset> [options]
  local launcher=()
  command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  cmake --preset "$1" "${launcher[@]}" "${@:2}"
}

build() { # <preset> [targets]
  local targets=()
  [ $# -eq 1 ] || targets=(--target "${@:2}")
  configure "$1" && cmake --build "build/$1" -j "$jobs" "${targets[@]}"
}

# ctest, with its counts added to ours. The head of its report has them: tests="5" failures="0" disabled="0" skipped="1"
run_tests() { # <folder below build> [options of ctest]
  local report=$PWD/build/$1/test-report.xml status=0
  rm -f "$report"
  ctest --test-dir "build/$1" --output-on-failure -j "$jobs" --output-junit "$report" "${@:2}" || status=$?
  [ -s "$report" ] || { echo "test: ctest wrote no report" >&2; return 1; }
  count() { sed -n "s/^[[:space:]]*$1=\"\([0-9]*\)\".*/\1/p" "$report" | head -n 1; }
  local total fails skips
  total=$(count tests)
  fails=$(count failures)
  skips=$(($(count skipped) + $(count disabled)))
  [ "$total" -gt 0 ] || { echo "test: no tests ran" >&2; return 1; }
  # Whatever else ctest has to complain about is one failure, too.
  [ "$status" -eq 0 ] || [ "$fails" -gt 0 ] || fails=1
  passed=$((passed + total - fails - skips))
  failed=$((failed + fails))
  skipped=$((skipped + skips))
  counted=1
  [ "$fails" -eq 0 ]
}

check_format() {
  git ls-files -z '*.cpp' '*.hpp' | xargs -0 -n 64 -P "$jobs" clang-format --dry-run --Werror
}

# A build folder of clang's own, for its compile commands; of the build it needs what is generated only.
configure_clang() {
  cmake --preset clang >/dev/null && cmake --build build/clang --target pfvox_make_module_id
}

# What clang has to say about what fuzzing, which builds libformat with it, leaves out: without code, which costs a part of
# a build.
compile_with_clang() {
  configure_clang || return
  sed -n 's/^  "command": "\(.*\)",$/\1/p' build/clang/compile_commands.json |
    sed -e 's/\\"/"/g; s/\\\\/\\/g' | grep -E " -c $PWD/(tools|libbake|viewer)/" |
    sed -e 's/ -o [^ ]* -c / -fsyntax-only -Werror /' |
    (cd build/clang && tr '\n' '\0' | xargs -0 -n 1 -P "$jobs" sh -c)
}

# What changed since the branch left main. A shallow clone does not know.
check_changes() {
  local base="" branch
  for branch in origin/main origin/master main; do
    base=$(git merge-base HEAD "$branch" 2>/dev/null) && break
  done
  if [ -z "$base" ]; then
    echo "skipped: this clone does not know where its branch left main"
    return 0
  fi
  local files
  mapfile -t files < <(git diff --numstat --diff-filter=d --no-renames "$base" -- '*.cpp' | sort -rn | cut -f 3 |
    grep -E '^(libformat|libbake|tools|viewer)/')
  if [ ${#files[@]} -eq 0 ]; then
    echo "no source changed since ${base:0:12}"
    return 0
  fi
  configure_clang || return
  printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$jobs" clang-tidy --quiet -p build/clang --warnings-as-errors='*' 2>/dev/null # counts of what it keeps back
}

# Its suppressions stand where they are needed; what it cannot parse is no finding.
check_with_cppcheck() {
  cppcheck --quiet --error-exitcode=1 --std=c++20 --language=c++ --inline-suppr -j "$jobs" \
    --enable=warning,performance,portability --suppressions-list=.cppcheck-suppressions \
    -I libformat/include -I libformat/src -I libbake/include -I libbake/src -I tools \
    libformat libbake tools viewer
}

# Without the GPU's part, whose drivers are not instrumented. Clang builds it, warnings are errors, and the fuzz targets
# share its objects.
test_with_sanitizers() {
  build fuzz && run_tests fuzz -LE "slow|docs|slurm"
}

# Conversion, folder mode, the loader and the baker's part on the processor, with data races as errors.
test_threads() {
  local targets=(vox2pf test_vox2pf test_tools_common test_scene test_octree_properties test_bake_parts) target
  build tsan "${targets[@]}" || return
  for target in "${targets[@]:1}"; do
    "build/tsan/bin/$target" --gtest_brief=1 || return
  done
}

fuzz() {
  local targets=(fuzz_pf_vox_decode fuzz_pf_probe_decode fuzz_scene fuzz_vox_import) target
  build fuzz "${targets[@]}" || return
  for target in "${targets[@]}"; do
    mkdir -p "build/fuzz/corpus/$target"
    # Without a largest length, the three large models of data/ make imports nine times as slow.
    (cd build/fuzz && "bin/$target" -max_total_time=20 -timeout=20 -max_len=65536 -print_final_stats=0 "corpus/$target" ../../data ../../tests/golden/data) ||
      return
  done
}
