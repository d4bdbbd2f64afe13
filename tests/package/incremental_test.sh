#!/usr/bin/env bash
# A build with assets does what changed, and nothing else.
# incremental_test.sh <prefix> <generator> <name>
source "$(dirname "$0")/lib.sh"

generator=$2
work=$(new_folder "incremental $3")
prefix=$work/pfvox # a copy: this test changes the time of a program
cp -a "$1" "$prefix"
source=$work/source
assets=$source/assets
out="$work/build/built assets"
log=$work/build.log
plain=$out/plain.pf_vox
words="$out/more props/it's two words.pf_vox"

mkdir -p "$assets/more props"
cp "$PFVOX_SOURCE_DIR/tests/package/assets-project/CMakeLists.txt" "$source"
cp "$PFVOX_SOURCE_DIR/data/lamp.vox" "$assets/plain.vox"
cp "$PFVOX_SOURCE_DIR/data/lamp.vox" "$assets/original.vox"
cp "$PFVOX_SOURCE_DIR/data/tree.vox" "$assets/more props/it's two words.vox"
printf '[[override]]\nfiles = "more props/**"\nimport.voxelSizeMetres = 0.2\n' >"$assets/pfvox.toml"
# One model that this build makes, one that it knows from the depfile only.
mkdir "$work/extern"
"$prefix/bin/vox2pf" -q "$PFVOX_SOURCE_DIR/data/lamp.vox" -o "$work/extern/post.pf_vox"
cat >"$assets/level.toml" <<END
probeGridPos = [1.0, 1.0, 2.0]
probeGridStep = 1.0
probeGridCount = [1, 1, 1]
proximityGridSize = [4, 4, 4]
[[models]]
path = "plain.vox"
[[models]]
path = "../../extern/post.pf_vox"
translateVec = [2.0, 0.0, 0.0]
END

# Builds, and keeps what was said. Time stamps of make are compared to the file system's resolution, so a moment passes.
build() {
  sleep 0.05
  cmake --build "$work/build" -j 4 >"$log" 2>&1
}
expect_build() { build || { cat "$log" >&2; fail "$1: the build failed"; }; }
# What a build did: the comments of its commands, in any order.
expect_done() { # <after what> <comment>...
  local after=$1 comment
  shift
  expect_build "$after"
  for comment in "$@"; do
    expect_text "$log" "$comment"
  done
  local count
  count=$(grep -cE '\] (Converting|Baking) ' "$log" || true)
  [ "$count" = $# ] || { cat "$log" >&2; fail "$after: $count commands ran, not $#"; }
}
# Does what follows run where an input was made again with the same bytes? ninja sees that they are the same.
light=()
light_again=()
if [ "$PFVOX_GPU" = ON ]; then
  light=("Baking level.pf_probe")
  [ "$generator" = Ninja ] || light_again=("Converting level.toml" "${light[@]}")
  scene=("Converting level.toml" "${light[@]}")
else
  scene=()
fi
both=("Converting plain.vox" "Converting more props/it's two words.vox")

configure "$source" "$work/build" "$prefix" "$generator" || { cat "$work/build.configure.log"; fail "configure"; }

expect_done "first build" "${both[@]}" "Converting made.vox" "${scene[@]}"
expect_file "$plain"
expect_file "$words"
expect_file "$work/build/made_voxels/made.pf_vox"
"$prefix/bin/vox2pf" info --json "$words" | grep -qF '"voxelSizeMetres":0.2' || fail "the override did not reach a file in a folder"
if [ "$PFVOX_GPU" = ON ]; then
  expect_text "$out/level.toml" '"plain.pf_vox"'
  "$prefix/bin/probe-bake" validate "$out/level.pf_probe" >/dev/null
fi

expect_done "nothing"
[ "$generator" != Ninja ] || expect_text "$log" "no work to do"

if [ "$PFVOX_GPU" = ON ]; then
  cmake --build "$work/build" -j 4 --target other_light >"$log" 2>&1 || { cat "$log" >&2; fail "the target other_light"; }
  expect_text "$log" "Baking other.pf_probe"
  expect_no_text "$log" "Converting"
fi

cp "$plain" "$work/plain.before"
touch "$assets/plain.vox"
expect_done "a touch" "Converting plain.vox" "${light_again[@]}"
expect_same "$plain" "$work/plain.before"
expect_done "nothing after a touch"

cp "$PFVOX_SOURCE_DIR/data/statue.vox" "$assets/plain.vox"
expect_done "an edit" "Converting plain.vox" "${scene[@]}"
expect_differ "$plain" "$work/plain.before"
expect_done "nothing after an edit"

cp "$PFVOX_SOURCE_DIR/data/tree.vox" "$assets/original.vox"
expect_done "an edit of what a source is made from" "Converting made.vox"

if [ "$PFVOX_GPU" = ON ]; then
  cp "$out/level.pf_probe" "$work/light.before"
  "$prefix/bin/vox2pf" -q --force --voxel-size 0.15 "$PFVOX_SOURCE_DIR/data/lamp.vox" -o "$work/extern/post.pf_vox"
  expect_done "a change of a file that only the depfile names" "${light[@]}"
  expect_differ "$out/level.pf_probe" "$work/light.before"
  expect_done "nothing after it"
fi

{ printf '[encode]\nzstdLevel = 9\n'; cat "$assets/pfvox.toml"; } >"$work/new.toml"
cp "$work/new.toml" "$assets/pfvox.toml"
expect_build "other settings"
for comment in "${both[@]}"; do expect_text "$log" "$comment"; done
expect_done "nothing after other settings"

cmake "$work/build" -DEXTRA_OPTIONS=--lod >/dev/null
expect_build "other options"
for comment in "${both[@]}"; do expect_text "$log" "$comment"; done
expect_done "nothing after other options"

touch "$prefix/bin/vox2pf"
cp "$plain" "$work/plain.before"
expect_build "another vox2pf"
for comment in "${both[@]}"; do expect_text "$log" "$comment"; done
expect_same "$plain" "$work/plain.before"
expect_done "nothing after another vox2pf"

head -c 500 "$PFVOX_SOURCE_DIR/data/lamp.vox" >"$assets/plain.vox"
if build; then fail "a broken asset did not fail the build"; fi
expect_text "$log" "plain.vox: "
expect_same "$plain" "$work/plain.before"
if build; then fail "a broken asset failed the build only once"; fi
cp "$PFVOX_SOURCE_DIR/data/lamp.vox" "$assets/plain.vox"
expect_done "the repair" "Converting plain.vox" "${scene[@]}"
expect_done "nothing after the repair"
