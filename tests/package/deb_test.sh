#!/usr/bin/env bash
# The Debian packages: made, unpacked into an empty root, and used from there.
source "$(dirname "$0")/lib.sh"

work=$(new_folder deb)
root=$PFVOX_WORK_DIR/debroot # where the other tests find it
rm -rf "$root"
cpack --config "$PFVOX_BUILD_DIR/CPackConfig.cmake" -G DEB -B "$work" >"$work/cpack.log" 2>&1 ||
  { cat "$work/cpack.log"; fail "cpack"; }

packages=(pfvox-tools libpfvox-dev)
if [ "$PFVOX_GPU" = ON ]; then packages+=(pfvox-viewer); fi
for package in "${packages[@]}"; do
  file=$(echo "$work/${package}_${PFVOX_VERSION}"_*.deb)
  expect_file "$file"
  dpkg-deb --info "$file" >"$work/$package.info"
  dpkg-deb --contents "$file" >"$work/$package.contents"
  for field in "Package: $package" "Version: $PFVOX_VERSION" "Maintainer: " "Section: " "Description: " "Depends: "; do
    expect_text "$work/$package.info" " $field"
  done
  for note in copyright changelog.gz CHANGELOG.md; do expect_text "$work/$package.contents" "./usr/share/doc/$package/$note"; done
  dpkg -x "$file" "$root"
done

# What programs load, found by their own symbols, and what the module loads, which no program links.
expect_text "$work/pfvox-tools.info" "libc6 (>= "
expect_text "$work/pfvox-tools.info" "libzstd1"
expect_text "$work/pfvox-tools.info" "libopenvdb"
expect_text "$work/libpfvox-dev.info" "pfvox-tools (= $PFVOX_VERSION)"
if [ "$PFVOX_GPU" = ON ]; then
  expect_text "$work/pfvox-viewer.info" "libvulkan1"
  expect_text "$work/pfvox-tools.info" "libvulkan1" # opened by name, too
fi
expect_text "$work/pfvox-tools.info" " Description: converter of voxel assets"
expect_no_text "$work/libpfvox-dev.contents" "/usr/bin/"
expect_no_text "$work/pfvox-tools.contents" ".hpp"

expect_text "$work/pfvox-tools.contents" "./usr/share/man/man1/vox2pf.1.gz"
# Programs carry the licences of the code that was compiled into them.
expect_text "$root/usr/share/doc/pfvox-tools/copyright" "CLI11"
if [ "$PFVOX_GPU" = ON ]; then expect_text "$root/usr/share/doc/pfvox-viewer/copyright" "Omar Cornut"; fi

# What Debian's own checker calls an error or a warning. Builds that were not configured for /usr, as packages are, put their
# libraries into "lib"; two of its warnings are about that.
if command -v lintian >/dev/null; then
  lintian --allow-root --suppress-tags pkg-config-unavailable-for-cross-compilation,maintscript-calls-ldconfig \
    --fail-on error,warning "$work"/*.deb || fail "lintian"
fi

expect_tools_work "$root/usr" "$work"
