// The ground under a model that is shown alone: level, neutral, seen from above only, and fading into the background.
#ifndef PFVOX_VIEW_GROUND_GLSL
#define PFVOX_VIEW_GROUND_GLSL

const vec3 kGroundAlbedo = vec3(0.32);
const vec3 kGroundNormal = vec3(0.0, 1.0, 0.0);
const float kGroundFades = 0.15;  // from this part of the radius on

bool isGround(SeenPixel seen) { return seen.material == kGroundMaterial; }

// Metres along a ray of unit direction; kInfinity where it does not meet the ground.
float groundAlong(ViewParameters view, Ray ray) {
    float height = ray.origin.y - view.groundMiddle.y;
    if (view.groundRadius <= 0.0 || height < 0.0 || ray.direction.y >= 0.0) return kInfinity;
    float t = height / -ray.direction.y;
    vec2 apart = (ray.origin + t * ray.direction - view.groundMiddle).xz;
    return t < ray.tMax && dot(apart, apart) < view.groundRadius * view.groundRadius ? t : kInfinity;
}

// How much of what is seen at a point of the ground is the ground; the rest is the background.
float groundFraction(ViewParameters view, vec3 position) {
    return 1.0 - smoothstep(kGroundFades, 1.0, length((position - view.groundMiddle).xz) / view.groundRadius);
}

// As it counts for rays that start there, in metres.
float groundVoxel(ViewParameters view) { return 0.02 * view.ambientReach; }

MaterialRecord groundMaterial() {
    return MaterialRecord(kGroundAlbedo, 0.0, 0u, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0u);
}

#endif
