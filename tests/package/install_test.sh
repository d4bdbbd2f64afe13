#!/usr/bin/env bash
# cmake --install: the right files, and a tree that works after it was moved.
source "$(dirname "$0")/lib.sh"

work=$(new_folder install)
installed=$PFVOX_WORK_DIR/installed # where the other tests find it
rm -rf "$installed"
cmake --install "$PFVOX_BUILD_DIR" --prefix "$work/first place" --strip >"$work/install.log"
mv "$work/first place" "$installed"

for component in tools dev; do
  cmake --install "$PFVOX_BUILD_DIR" --prefix "$work/$component" --component $component --strip >"$work/$component.log"
done
expect_file "$work/tools/bin/vox2pf"
expect_no_file "$work/tools/include"
expect_no_file "$work/dev/bin"
expect_file "$work/dev/include/pfvox/pf_vox.hpp"

# Nothing of the machine it was built on is left in what is text; programs look for nothing in folders of their own.
if grep -rlF -e "$PFVOX_BUILD_DIR" -e "$PFVOX_SOURCE_DIR" "$installed/$PFVOX_LIBDIR/cmake" "$installed/$PFVOX_LIBDIR/pkgconfig"; then
  fail "these files name the build or source folder"
fi
for program in "$installed"/bin/*; do
  if readelf -d "$program" | grep -E 'R(UN)?PATH'; then fail "$program has a run path"; fi
done

# Links of the installed documents lead to installed files.
documents=$installed/share/doc/libpfvox-dev
expect_file "$documents/docs/cmake.md"
while IFS=: read -r document target; do
  target=${target#](}
  [ -e "$(dirname "$document")/${target%%[#)]*}" ] || fail "$document links to $target, which is not installed"
done < <(grep -roE --include='*.md' '\]\([^)#:]+[)#]' "$documents/docs" "$documents/examples")

expect_tools_work "$installed" "$work"

# A tree without the module says what is missing.
module_is_installed && exit 0
cp -r "$work/tools" "$work/no module"
rm "$work/no module/$PFVOX_LIBDIR/pfvox/pfvox_vdb.so"
status=0
"$work/no module/bin/vox2pf" "$work/lamp.vdb" -o "$work/never.pf_vox" 2>"$work/module.log" || status=$?
[ "$status" = 5 ] || fail "exit code $status without the module, not 5"
expect_text "$work/module.log" "no module/$PFVOX_LIBDIR/pfvox"
