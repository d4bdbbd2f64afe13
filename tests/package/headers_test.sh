#!/usr/bin/env bash
# Every installed header compiles alone, with what its users have: nothing of the source tree.
source "$(dirname "$0")/lib.sh"

prefix=$1
work=$(new_folder headers)
for header in "$prefix"/include/pfvox/*.hpp; do
  echo "#include <pfvox/$(basename "$header")>" >"$work/$(basename "$header" .hpp).cpp"
done
count=$(find "$work" -name '*.cpp' | wc -l)
# shellcheck disable=SC2086 # the flags are words
find "$work" -name '*.cpp' -print0 | xargs -0 -n 1 -P "$(nproc)" \
  "$PFVOX_CXX" $PFVOX_CXX_FLAGS -std=c++20 -fsyntax-only -Wall -Wextra -Werror -I "$prefix/include" ||
  fail "these headers do not compile alone"
[ "$count" -ge 20 ] || fail "only $count headers in $prefix/include/pfvox"
expect_no_file "$prefix/include/pfvox/importer.hpp" # a private one
echo "$count headers"
