#!/usr/bin/env bash
# Every printable character in names: a build is told it rightly, or says which character it cannot be told.
# names_test.sh <prefix> <generator> <name>
source "$(dirname "$0")/lib.sh"

prefix=$1
generator=$2
work=$(new_folder "names $3")
source=$work/source
build=$work/build
log=$work/build.log
model=$PFVOX_SOURCE_DIR/data/lamp.vox

# The names, "a" + character + "b": of a folder and of what is in it. CMake quotes some characters for the shell only beside
# others, and wants brackets in pairs.
names=()
for code in {32..126}; do
  printf -v character "\\x$(printf %x "$code")"
  case $character in
    [A-Za-z0-9/] | ']') continue ;;
    '[') names+=("a[ ]b") ;;
    '?' | '{') names+=("a${character} b") ;;
    *) names+=("a${character}b") ;;
  esac
done
names+=("aéb" "a漢字b")

refused='[#<>|;\]'
refused_in_bakes='["$&'"'"'*:?^`]'
if [ "$generator" != Ninja ]; then
  refused='[][#<>|;\:%*?]'
  refused_in_bakes='["=]'
fi

project() { # <lines>
  mkdir -p "$source"
  printf 'cmake_minimum_required(VERSION 3.25)\nproject(p LANGUAGES NONE)\n%s\n%s\n' \
    'find_package(pfvox CONFIG REQUIRED COMPONENTS tools)' "$1" >"$source/CMakeLists.txt"
  cmake -S "$source" -B "$build" -G "$generator" -Dpfvox_DIR="$prefix/$PFVOX_LIBDIR/cmake/pfvox" >"$log" 2>&1
}
refuses() { # <lines> <character>
  if project "$1"; then fail "accepted: $1"; fi
  tr -s ' \n' '  ' <"$log" >"$log.line"
  expect_text "$log.line" " has the character $2, which "
  expect_text "$log.line" "Rename that file or folder."
}
quoted() { printf '[==[%s]==]' "$1"; }
# What a build did; every second one must do nothing.
expect_builds() { # <after what> <converted> <baked>
  sleep 0.05
  cmake --build "$build" -j 4 >"$log" 2>&1 || { cat "$log" >&2; fail "$1: the build failed"; }
  local converted baked
  converted=$(grep -c '\] Converting ' "$log" || true)
  baked=$(grep -c '\] Baking ' "$log" || true)
  [ "$converted $baked" = "$2 $3" ] || { cat "$log" >&2; fail "$1: $converted converted and $baked baked, not $2 and $3"; }
}

# Models and scenes: one of each for every name, in one project.
sources=""
count=0
rest=() # names that can be told
scene_name=""
for name in "${names[@]}"; do
  if [[ $name =~ $refused ]]; then
    refuses "pfvox_add_assets(a SOURCES $(quoted "$name.vox"))" "${BASH_REMATCH[0]}"
    continue
  fi
  mkdir -p "$source/$name"
  cp "$model" "$source/$name/$name.vox"
  printf "[[models]]\npath = '''%s.pf_vox'''\n" "$name" >"$source/$name/$name.toml"
  sources+=" $(quoted "$name/$name.vox") $(quoted "$name/$name.toml")"
  count=$((count + 1))
  rest+=("$name")
  [[ $name =~ $refused_in_bakes ]] || scene_name+=${name:1:-1}
done
[ "$count" -ge 20 ] || fail "only $count names were tried"
assets="pfvox_add_assets(a ALL SOURCES $sources OUTPUT_DIR out)
pfvox_install_assets(TARGETS a DESTINATION game)"

# Bakes: a scene of all models, by a name of all characters that bakes can be told, and by one of all others.
bakes=0
if [ "$PFVOX_GPU" = ON ]; then
  bakes=2
  {
    printf 'probeGridPos = [1.0, 1.0, 2.0]\nprobeGridStep = 1.0\nprobeGridCount = [1, 1, 1]\nproximityGridSize = [4, 4, 4]\n'
    for name in "${rest[@]}"; do printf "[[models]]\npath = '''%s/%s.vox'''\n" "$name" "$name"; done
  } >"$source/all $scene_name.toml"
  other_name="other"
  for name in "${rest[@]}"; do
    if [[ $name =~ $refused_in_bakes ]]; then
      refuses "pfvox_add_probe_bake(b SCENE s.toml OUTPUT $(quoted "$name.pf_probe"))" "${BASH_REMATCH[0]}"
      other_name+=${name:1:-1}
    fi
  done
  cp "$source/all $scene_name.toml" "$source/$other_name.toml"
  draft="OPTIONS --resolution 16,8,8,14 --samples 16 --bounces 1"
  assets+="
pfvox_add_probe_bake(b ALL SCENE $(quoted "all $scene_name.toml") ASSETS a OUTPUT $(quoted "out/all $scene_name.pf_probe") $draft)
pfvox_add_probe_bake(c ALL SCENE $(quoted "$other_name.toml") ASSETS a OUTPUT out/other.pf_probe $draft)
pfvox_install_assets(TARGETS b c DESTINATION game)"
fi
refuses 'pfvox_add_assets(a SOURCES "a]b.vox" "a[b.vox")' '['

project "$assets" || { cat "$log" >&2; fail "configure"; }
expect_builds "first build" $((2 * count + bakes)) $bakes
expect_builds "nothing" 0 0
# Commands print nothing when all is well: what is left are the lines of the build system.
if grep -vE '^\[|^(make|gmake|ninja)|^$' "$log"; then fail "commands say something"; fi
for name in "${rest[@]}"; do
  expect_same "$build/out/$name/$name.pf_vox" "$build/out/${rest[0]}/${rest[0]}.pf_vox"
done
DESTDIR=$work/installed cmake --install "$build" --prefix / >/dev/null
(cd "$build/out" && find . -type f | sort) >"$work/built.list"
(cd "$work/installed/game" && find . -type f | sort) | cmp - "$work/built.list" || fail "what is installed is not what was built"

# An edit of each model reaches its output and the light.
for name in "${rest[@]}"; do cp "$PFVOX_SOURCE_DIR/data/tree.vox" "$source/$name/$name.vox"; done
sleep 0.05
cmake --build "$build" -j 4 >"$log" 2>&1 || { cat "$log" >&2; fail "build after edits"; }
for name in "${rest[@]}"; do expect_text "$log" "Converting $name/$name.vox"; done
[ "$(grep -c '\] Baking ' "$log" || true)" = $bakes ] || fail "the bakes did not follow"
expect_builds "nothing after edits" 0 0

# Depfiles by themselves, for people's own makefiles and ninja files.
plain=$work/plain
mkdir "$plain"
cd "$plain"
told=0
if_changed=()
[ "$generator" != Ninja ] || if_changed=(--if-changed)
for name in "${names[@]}"; do
  cp "$model" "$name.vox"
  if "$prefix/bin/vox2pf" "${if_changed[@]}" "$name.vox" -o "$told.pf_vox" --depfile "$told.d" >"$log" 2>&1; then
    told=$((told + 1))
  else
    expect_text "$log" "$name.vox: its path has "
    [ ! -e "$told.d" ] && [ ! -e "$told.pf_vox" ] || fail "something was written for $name"
    rm "$name.vox"
  fi
done
[ "$told" -ge 15 ] || fail "depfiles tell only $told names"
rebuilt() {
  if [ "$generator" = Ninja ]; then ninja; else "$(command -v gmake || echo make)" -s; fi >"$log" 2>&1 || { cat "$log" >&2; fail "the depfiles"; }
  grep -cx 'again' "$log" || true
}
if [ "$generator" = Ninja ]; then
  printf 'rule again\n  command = echo again; touch $out\n  depfile = $stem.d\n'
  for ((i = 0; i < told; ++i)); do printf 'build %d.pf_vox: again\n  stem = %d\n' "$i" "$i"; done
else
  printf 'all: %s\n' "$(printf '%d.pf_vox ' $(seq 0 $((told - 1))))"
  for ((i = 0; i < told; ++i)); do printf '%d.pf_vox: ; @echo again; touch $@\ninclude %d.d\n' "$i" "$i"; done
fi >"$([ "$generator" = Ninja ] && echo build.ninja || echo Makefile)"
rebuilt >/dev/null
[ "$(rebuilt)" = 0 ] || { cat "$log"; fail "depfiles name what is not there"; }
sleep 0.05
touch ./*.vox
[ "$(rebuilt)" = "$told" ] || { cat "$log"; fail "depfiles do not name every source"; }

# No rule gets in by a name.
rm -f ./*.d
printf -v name 'x:\nall:;touch\tPWNED;\tb.vox'
cp "$model" "$name"
status=0
"$prefix/bin/vox2pf" "${if_changed[@]}" . -o out --depfile all.d >"$log" 2>&1 || status=$?
[ "$status" = 4 ] || fail "exit code $status for a name with line ends, not 4"
[ ! -e all.d ] || fail "there is a depfile of a name with line ends"
echo "$count names in builds, $told in depfiles"
