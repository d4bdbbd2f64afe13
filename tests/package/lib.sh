# What the package tests share. Sourced; needs PFVOX_BUILD_DIR, PFVOX_SOURCE_DIR, PFVOX_WORK_DIR in the environment.
set -euo pipefail

fail() { echo "FAILED: $*" >&2; exit 1; }

# A new, empty folder for one test; its name has spaces, as folders of users have.
new_folder() {
  local folder="$PFVOX_WORK_DIR/$1"
  rm -rf "$folder"
  mkdir -p "$folder"
  echo "$folder"
}

expect_file() { [ -s "$1" ] || fail "there is no $1"; }
expect_no_file() { [ ! -e "$1" ] || fail "$1 should not be there"; }
expect_same() { cmp -s "$1" "$2" || fail "$1 and $2 differ"; }
expect_differ() { ! cmp -s "$1" "$2" || fail "$1 and $2 are the same"; }
expect_text() { grep -qF -- "$2" "$1" || { tail -n 40 "$1" | cut -c -300 >&2; fail "'$2' is not in $1"; }; }
expect_no_text() { ! grep -qF -- "$2" "$1" || { tail -n 40 "$1" | cut -c -300 >&2; fail "'$2' is in $1"; }; }

# Configures a project that sees nothing but an installed pfvox.
configure() { # <source> <build> <prefix> <generator> [further options]
  local source=$1 build=$2 prefix=$3 generator=$4
  shift 4
  cmake -S "$source" -B "$build" -G "$generator" -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_CXX_COMPILER="$PFVOX_CXX" -DCMAKE_CXX_FLAGS="$PFVOX_CXX_FLAGS" "$@" >"$build.configure.log" 2>&1
}

# Whether programs without a module of their own would find one that this machine has installed.
module_is_installed() { [ -e "$PFVOX_INSTALLED_MODULE" ]; }

# Programs of a prefix read and write a voxel file of each kind: what they load is where they look for it.
expect_tools_work() { # <prefix> <folder for files>
  local bin=$1/bin out=$2
  "$bin/vox2pf" --version >/dev/null
  "$bin/vox2pf" "$PFVOX_SOURCE_DIR/data/lamp.vox" -o "$out/lamp.pf_vox"
  # Both ways through the OpenVDB module.
  "$bin/vox2pf" export "$out/lamp.pf_vox" -o "$out/lamp.vdb"
  "$bin/vox2pf" "$out/lamp.vdb" -o "$out/back.pf_vox"
  "$bin/vox2pf" validate "$out"
  if [ "$PFVOX_GPU" = ON ]; then
    "$bin/probe-bake" --version >/dev/null
    "$bin/pfview" "$out/back.pf_vox" --screenshot "$out/lamp.png" --size 64x64 -q
    expect_file "$out/lamp.png"
  fi
}
