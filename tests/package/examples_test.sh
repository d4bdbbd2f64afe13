#!/usr/bin/env bash
# The examples, built outside the repository from the installed package alone.
# examples_test.sh <prefix> <generator> <name>
source "$(dirname "$0")/lib.sh"

prefix=$1
work=$(new_folder "examples $3")
examples=$prefix/share/doc/libpfvox-dev/examples
expect_file "$examples/README.md"

build() { # <example>
  cp -r "$examples/$1" "$work/$1"
  configure "$work/$1" "$work/$1-build" "$prefix" "$2" || { cat "$work/$1-build.configure.log"; fail "configure $1"; }
  cmake --build "$work/$1-build" >"$work/$1.log" 2>&1 || { cat "$work/$1.log"; fail "build $1"; }
}

build game-assets "$2"
game=$work/game-assets-build
for model in terrace props/lamp "props/metal ball"; do expect_file "$game/assets/$model.pf_vox"; done
"$prefix/bin/vox2pf" validate "$game/assets"
if [ "$PFVOX_GPU" = ON ]; then
  "$game/game" "$game/assets/level1.toml" >"$work/game.log"
  cat "$work/game.log"
  expect_text "$work/game.log" "level1.toml: 5 models"
  expect_text "$work/game.log" "level1.pf_probe: 24 probes"
  expect_file "$game/level1.png"
  # The folder is complete: it loads where it is put.
  cmake --install "$game" --prefix "$work/shipped" >/dev/null
  rm -rf "$work/game-assets"
  mv "$game" "$work/gone"
  "$work/shipped/game" "$work/shipped/assets/level1.toml" | cmp - "$work/game.log" || fail "the installed game loads something else"
  game=$work/gone
fi

build walk-octree "$2"
"$work/walk-octree-build/walk-octree" "$game/assets/props/lamp.pf_vox" >"$work/walk.log"
head -n 12 "$work/walk.log"
expect_text "$work/walk.log" "level  0:        1 nodes"
expect_text "$work/walk.log" "emit"

# The same program without CMake.
export PKG_CONFIG_PATH=$prefix/$PFVOX_LIBDIR/pkgconfig
# shellcheck disable=SC2046,SC2086 # the flags are words
"$PFVOX_CXX" -std=c++20 $PFVOX_CXX_FLAGS $(pkg-config --cflags pfvox-format) "$work/walk-octree/walk_octree.cpp" \
  $(pkg-config --libs pfvox-format) -o "$work/walk"
"$work/walk" "$game/assets/props/lamp.pf_vox" | cmp - "$work/walk.log" || fail "the program of pkg-config prints something else"
