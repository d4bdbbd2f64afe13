# Writes a SPIR-V module as a C++ source. Use: cmake -DNAME=<constant> -DHEADER=<shaders.hpp> -DMODULE=<in.spv> -DOUTPUT=<out.cpp> -P EmbedSpirv.cmake
file(READ ${MODULE} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1u, " words "${bytes}") # SPIR-V words are little endian
string(REGEX REPLACE "((0x[0-9a-f]+u, )(0x[0-9a-f]+u, )(0x[0-9a-f]+u, )(0x[0-9a-f]+u, )(0x[0-9a-f]+u, )(0x[0-9a-f]+u, )(0x[0-9a-f]+u, ))"
       "\\1\n    " words "${words}")
file(WRITE ${OUTPUT} "// Generated from ${NAME}.spv by cmake/EmbedSpirv.cmake.
#include <${HEADER}>

namespace {
constexpr std::uint32_t kWords[] = {
    ${words}
};
}  // namespace

const std::span<const std::uint32_t> pfvox::shaders::${NAME} = kWords;
")
