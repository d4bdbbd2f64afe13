# What Doxygen reads instead of a header (INPUT_FILTER; run by sed -E).
# The head of a file becomes its description.
1,/^#pragma once/ s|^//|///|
1 s|^///|/// \\file\n///|
# What the compiler writes, and what is only for a macro, is not listed.
s/^ *bool operator==\(const.*(default;|\})//
s/^ *(explicit )?[A-Za-z]+\([A-Za-z]+&&( [a-z]+)?\) noexcept;//
s/^ *[A-Za-z]+& operator=\([A-Za-z]+&&( [a-z]+)?\) noexcept;//
/^#define PFVOX_TRY_IMPL/,/[^\\]$/ s/.*//
# A comment behind several members is about each.
s|^( *[A-Za-z0-9_:]+) x, y, z;( *///<.*)$|\1 x;\2\n\1 y;\2\n\1 z;\2|
