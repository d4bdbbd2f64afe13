#!/usr/bin/env bash
# What find_package and the functions say: to right calls nothing, to wrong ones what is wrong and what to do.
# find_package_test.sh <prefix>
source "$(dirname "$0")/lib.sh"

prefix=$1
work=$(new_folder "find package")
cp "$PFVOX_SOURCE_DIR/data/lamp.vox" "$work/lamp.vox"

# Configures a project of these lines; its messages are in $log. One build folder for all, to find the compiler once.
log=$work/build.configure.log
project() { # <lines> [further options]
  local lines=$1
  shift
  mkdir -p "$work/project/assets"
  cp "$work/lamp.vox" "$work/project/assets"
  printf 'cmake_minimum_required(VERSION 3.25)\nproject(p LANGUAGES CXX)\n%s\n' "$lines" >"$work/project/CMakeLists.txt"
  configure "$work/project" "$work/build" "$prefix" Ninja "$@"
}
good() { project "$@" || { cat "$log" >&2; fail "refused: $1"; }; }
# CMake breaks its messages into lines: compare with all blanks as one.
bad() { # <lines> <words of the message> [further options]
  local lines=$1 words=$2
  shift 2
  if project "$lines" "$@"; then fail "accepted: $lines"; fi
  tr -s ' \n' '  ' <"$log" >"$log.line"
  grep -qF -- "$words" "$log.line" || { cat "$log" >&2; fail "'$words' is not in the message of: $lines"; }
}
find='find_package(pfvox CONFIG REQUIRED COMPONENTS tools)'

good 'find_package(pfvox CONFIG REQUIRED)
foreach(name format import vox2pf vdb_module)
  if(NOT TARGET pfvox::${name})
    message(FATAL_ERROR "no pfvox::${name}")
  endif()
endforeach()
if(NOT COMMAND pfvox_add_assets)
  message(FATAL_ERROR "no pfvox_add_assets")
endif()'
good "find_package(pfvox $PFVOX_VERSION CONFIG REQUIRED COMPONENTS format import)"
bad 'find_package(pfvox 0.0 CONFIG REQUIRED)' 'compatible with requested version "0.0"'
bad 'find_package(pfvox 99 CONFIG REQUIRED)' 'compatible with requested version "99"'
bad 'find_package(pfvox CONFIG REQUIRED COMPONENTS sound)' 'The component sound needs such a component: there are format, import'
bad 'set(CMAKE_DISABLE_FIND_PACKAGE_pugixml ON)
find_package(pfvox CONFIG REQUIRED COMPONENTS import)' 'The component import needs the package pugixml'
bad 'set(CMAKE_DISABLE_FIND_PACKAGE_TBB ON)
find_package(pfvox CONFIG REQUIRED COMPONENTS import)' 'The component import needs the component format, the package TBB'
good 'set(CMAKE_DISABLE_FIND_PACKAGE_TBB ON)
find_package(pfvox CONFIG REQUIRED)
if(TARGET pfvox::format OR NOT TARGET pfvox::vox2pf)
  message(FATAL_ERROR "what lacks a dependency is left out, the rest is there")
endif()'

# Programs serve targets of any size, libraries one.
narrow='set(CMAKE_SIZEOF_VOID_P 4)'
good "$narrow
$find"
bad "$narrow
find_package(pfvox CONFIG REQUIRED COMPONENTS format)" 'The component format needs libraries for targets of 32 bits'

assets='SOURCES assets/lamp.vox BASE_DIR assets'
# Programs of this machine, for cross builds: in place of those of the package, and where it has none.
mkdir "$work/host"
printf '#!/bin/sh\necho "$@" >>"%s"\nexec "%s" "$@"\n' "$work/host/calls" "$prefix/bin/vox2pf" >"$work/host/vox2pf"
chmod +x "$work/host/vox2pf"
cross=(-DCMAKE_SYSTEM_NAME=Linux)
bad "$find" 'needs the program vox2pf in PFVOX_HOST_TOOLS_DIR (/nowhere)' -DPFVOX_HOST_TOOLS_DIR=/nowhere
rm -rf "$work/build"
good "$find
pfvox_add_assets(a ALL $assets)" "${cross[@]}" -DPFVOX_HOST_TOOLS_DIR="$work/host"
cmake --build "$work/build" >"$log" 2>&1 || { cat "$log" >&2; fail "build with host tools"; }
expect_text "$work/host/calls" "lamp.vox"
rm -rf "$work/build"
bad "$find
pfvox_add_assets(a OUTPUT_DIR out)" 'pfvox_add_assets(a): SOURCES is missing'
bad "$find
pfvox_add_assets(a COLOR red $assets)" 'pfvox_add_assets(a): unknown argument: COLOR red'
bad "$find
pfvox_add_assets(a $assets SETTINGS)" 'pfvox_add_assets(a): nothing follows SETTINGS'
bad "$find
pfvox_add_assets(a $assets)
pfvox_add_assets(a $assets)" 'pfvox_add_assets(a): there is a target of this name already'
bad "$find
pfvox_add_assets(a $assets lamp.vox)" 'pfvox_add_assets(a): unknown argument: lamp.vox'
bad "$find
pfvox_add_assets(a BASE_DIR assets SOURCES /elsewhere/lamp.vox)" 'is not below BASE_DIR'
bad "$find
pfvox_add_assets(a BASE_DIR assets SOURCES lamp.vox lamp.vdb)" 'pfvox_add_assets(a): two sources become'
bad "$find
pfvox_add_assets(a SOURCES assets/lamp.vox OUTPUT_DIR \${CMAKE_CURRENT_SOURCE_DIR})" 'OUTPUT_DIR is BASE_DIR'
bad 'find_package(pfvox CONFIG REQUIRED COMPONENTS format)
pfvox_add_assets(a SOURCES assets/lamp.vox)' 'the program vox2pf is not there'
bad "$find
pfvox_install_assets(TARGETS a)" 'pfvox_install_assets: DESTINATION is missing'
bad "$find
pfvox_install_assets(TARGETS a DESTINATION d)" 'pfvox_install_assets: a is no target of pfvox_add_assets'

# Outputs of sources that are gone: kept, never installed, and removed by PRUNE; files of others are let alone.
cp "$work/lamp.vox" "$work/project/assets/gone.vox"
good "$find
pfvox_add_assets(a ALL BASE_DIR assets SOURCES lamp.vox gone.vox OUTPUT_DIR out)"
cmake --build "$work/build" >"$log" 2>&1 || { cat "$log" >&2; fail "build"; }
touch "$work/build/out/mine.pf_vox"
good "$find
pfvox_add_assets(a ALL $assets OUTPUT_DIR out)
pfvox_install_assets(TARGETS a DESTINATION game)"
expect_file "$work/build/out/gone.pf_vox"
cmake --install "$work/build" --prefix "$work/shipped" >/dev/null
expect_file "$work/shipped/game/lamp.pf_vox"
expect_no_file "$work/shipped/game/gone.pf_vox"
# What another target makes now is not gone.
good "$find
pfvox_add_assets(a ALL PRUNE $assets OUTPUT_DIR out)
pfvox_add_assets(b BASE_DIR assets SOURCES gone.vox OUTPUT_DIR out)"
expect_file "$work/build/out/gone.pf_vox"
good "$find
pfvox_add_assets(a ALL $assets OUTPUT_DIR out)
pfvox_add_assets(b BASE_DIR assets SOURCES gone.vox OUTPUT_DIR out)"
good "$find
pfvox_add_assets(a ALL $assets OUTPUT_DIR out)
pfvox_add_assets(b PRUNE BASE_DIR assets SOURCES lamp.vox OUTPUT_DIR b)"
expect_no_file "$work/build/out/gone.pf_vox"
expect_file "$work/build/out/lamp.pf_vox"
[ -e "$work/build/out/mine.pf_vox" ] || fail "PRUNE removed a file that it had not made"

bad "$find
pfvox_copy_vdb_module(nothing)" 'nothing' # CMake itself tells that there is no such target

if [ "$PFVOX_GPU" = ON ]; then
  bad "$find
pfvox_add_probe_bake(b SCENE s.toml)" 'pfvox_add_probe_bake(b): OUTPUT is missing'
  bad "$find
pfvox_add_probe_bake(b SCENE s.toml OUTPUT s.bin)" 'OUTPUT s.bin does not end in .pf_probe'
  bad "$find
pfvox_add_probe_bake(b SCENE s.toml OUTPUT s.pf_probe ASSETS a)" 'ASSETS a is no target of pfvox_add_assets'
  # A scene may be among the sources, too; what is baked is what it becomes.
  printf '[[models]]\npath = "lamp.vox"\n' >"$work/project/assets/level.toml"
  good "$find
pfvox_add_assets(a BASE_DIR assets SOURCES lamp.vox level.toml OUTPUT_DIR out)
pfvox_add_probe_bake(b SCENE assets/level.toml OUTPUT out/level.pf_probe ASSETS a)
get_target_property(scene b PFVOX_SCENE)
get_target_property(outputs a PFVOX_OUTPUTS)
message(STATUS \"scene \${scene} of \${outputs}\")"
  expect_text "$log" "scene $work/build/out/level.toml of $work/build/out/lamp.pf_vox;$work/build/out/level.toml"
  cmake --build "$work/build" --target a >"$log" 2>&1 || { cat "$log" >&2; fail "build"; }
  expect_text "$work/build/out/level.toml" '"lamp.pf_vox"'
  # The pool of bakes does not take away those of the project, however they are given.
  good "set(CMAKE_JOB_POOLS mine=3)
$find
pfvox_add_probe_bake(b SCENE s.toml OUTPUT s.pf_probe)
pfvox_add_probe_bake(c SCENE s.toml OUTPUT c.pf_probe)"
  expect_text "$work/build/CMakeFiles/rules.ninja" "pool mine"
  expect_text "$work/build/CMakeFiles/rules.ninja" "pool pfvox_gpu"
fi

# A program that imports, and finds OpenVDB support beside itself.
cat >"$work/project/convert.cpp" <<'END'
#include <pfvox/convert.hpp>

#include <cstdio>

int main(int, char** argv) {
    pfvox::DiagnosticList diagnostics;
    const auto report = pfvox::convertFile(argv[1], argv[2], {}, {}, diagnostics);
    if (!report) std::puts(describe(report.error()).c_str());
    return report ? 0 : 1;
}
END
good 'find_package(pfvox CONFIG REQUIRED COMPONENTS import tools)
add_executable(convert convert.cpp)
target_link_libraries(convert PRIVATE pfvox::import)
pfvox_copy_vdb_module(convert)'
cmake --build "$work/build" >"$log" 2>&1 || { cat "$log" >&2; fail "build"; }
"$prefix/bin/vox2pf" "$work/lamp.vox" -o "$work/lamp.pf_vox" >/dev/null
"$prefix/bin/vox2pf" export "$work/lamp.pf_vox" -o "$work/lamp.vdb" >/dev/null
"$work/build/convert" "$work/lamp.vdb" "$work/back.pf_vox"
expect_file "$work/back.pf_vox"
rm "$work/build/pfvox_vdb.so"
if ! module_is_installed; then
  if "$work/build/convert" "$work/lamp.vdb" "$work/back.pf_vox" >"$log"; then fail "a .vdb file was read without the module"; fi
  expect_text "$log" "put it beside the program"
fi

# As a folder of another project: the same functions and names, nothing installed.
good "set(PFVOX_BUILD_GPU OFF)
add_subdirectory(\"$PFVOX_SOURCE_DIR\" pfvox EXCLUDE_FROM_ALL)
pfvox_add_assets(a ALL $assets OUTPUT_DIR out)"
expect_no_text "$log" "faulty" # what Debian's Imath says of itself
# The build type is the parent's.
grep -qx 'CMAKE_BUILD_TYPE:STRING=' "$work/build/CMakeCache.txt" || fail "the build type of the parent was changed"
ninja -C "$work/build" -t commands a >"$log"
expect_text "$log" '/pfvox/bin/vox2pf" convert '
expect_text "$log" "vox2pf.dir/main.cpp.o" # which is made first

# Built for another machine it cannot convert: PFVOX_HOST_TOOLS_DIR has what can.
subproject="set(PFVOX_BUILD_GPU OFF)
add_subdirectory(\"$PFVOX_SOURCE_DIR\" pfvox EXCLUDE_FROM_ALL)
pfvox_add_assets(a ALL $assets OUTPUT_DIR out)"
rm -rf "$work/build"
bad "$subproject" 'Set PFVOX_HOST_TOOLS_DIR to the folder of one that does' "${cross[@]}"
good "$subproject" -DPFVOX_HOST_TOOLS_DIR="$work/host"
cmake --build "$work/build" --target a >"$log" 2>&1 || { cat "$log" >&2; fail "build of a subproject with host tools"; }
expect_file "$work/build/out/lamp.pf_vox"
