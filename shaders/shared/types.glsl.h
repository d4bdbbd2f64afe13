// The few types that shared headers use, for both readers. Only members whose std430 layout equals the C++ layout are
// used: 4-byte scalars, uvec2 on 8-byte offsets, vec3 and vec4 on 16-byte offsets.
#ifndef PFVOX_SHARED_TYPES_GLSL_H
#define PFVOX_SHARED_TYPES_GLSL_H

#ifdef __cplusplus

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

namespace pfvox::shared {
using uint = std::uint32_t;
using vec2 = glm::vec2;
using vec3 = glm::vec3;
using vec4 = glm::vec4;
using ivec2 = glm::ivec2;
using ivec3 = glm::ivec3;
using uvec2 = glm::uvec2;  // a 64-bit device address: x = low word
}  // namespace pfvox::shared

#define PFVOX_SHARED_BEGIN namespace pfvox::shared {
#define PFVOX_SHARED_END }
#define PFVOX_CONSTANT(type, name, value) inline constexpr type name = value
#define PFVOX_STRUCT(name) struct alignas(16) name
#define PFVOX_FUNCTION inline
// Pins a struct to its bytes; a member at the wrong offset does not compile.
#define PFVOX_SIZE(name, bytes) static_assert(sizeof(name) == (bytes))
#define PFVOX_OFFSET(name, member, bytes) static_assert(offsetof(name, member) == (bytes))

#else

#define PFVOX_SHARED_BEGIN
#define PFVOX_SHARED_END
#define PFVOX_CONSTANT(type, name, value) const type name = value
#define PFVOX_STRUCT(name) struct name
#define PFVOX_FUNCTION
#define PFVOX_SIZE(name, bytes)
#define PFVOX_OFFSET(name, member, bytes)

#endif
#endif
