// The one sRGB curve (IEC 61966-2-1), read by C++ and GLSL. Arguments from 0 to 1; C++ takes float or double.
#ifndef PFVOX_SHARED_COLOR_GLSL_H
#define PFVOX_SHARED_COLOR_GLSL_H

#include "shared/types.glsl.h"

#ifdef __cplusplus
#include <cmath>
#define PFVOX_OF_ANY_REAL template <class Real>
#define PFVOX_VEC3 glm::vec<3, Real>
#else
#define PFVOX_OF_ANY_REAL
#define PFVOX_VEC3 vec3
#define Real float
#endif

PFVOX_SHARED_BEGIN

#ifdef __cplusplus
using std::pow;
#endif

PFVOX_OF_ANY_REAL PFVOX_FUNCTION Real linearFromSrgb(Real c) {
    return c <= Real(0.04045) ? c / Real(12.92) : pow((c + Real(0.055)) / Real(1.055), Real(2.4));
}
PFVOX_OF_ANY_REAL PFVOX_FUNCTION Real srgbFromLinear(Real c) {
    return c <= Real(0.0031308) ? Real(12.92) * c : Real(1.055) * pow(c, Real(1.0) / Real(2.4)) - Real(0.055);
}

PFVOX_OF_ANY_REAL PFVOX_FUNCTION PFVOX_VEC3 linearFromSrgb(PFVOX_VEC3 c) {
    return PFVOX_VEC3(linearFromSrgb(c.x), linearFromSrgb(c.y), linearFromSrgb(c.z));
}
PFVOX_OF_ANY_REAL PFVOX_FUNCTION PFVOX_VEC3 srgbFromLinear(PFVOX_VEC3 c) {
    return PFVOX_VEC3(srgbFromLinear(c.x), srgbFromLinear(c.y), srgbFromLinear(c.z));
}

PFVOX_SHARED_END

#undef PFVOX_OF_ANY_REAL
#undef PFVOX_VEC3
#ifndef __cplusplus
#undef Real
#endif
#endif
