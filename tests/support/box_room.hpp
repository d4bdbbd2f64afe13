// BoxRoom: a closed room with boxes in it, traced analytically: what probe layers and the proximity grid are
// tested on.
#pragma once

#include <pfvox/probe_maths.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace pfvox::test {

struct RoomHit {
    float distance = std::numeric_limits<float>::infinity();
    glm::vec3 normal{0.0f};
    int surface = -1;  ///< 0 the walls, 1.. the boxes
};

class BoxRoom {
  public:
    struct Box {
        glm::vec3 min;
        glm::vec3 max;
    };

    static constexpr float kVoxelMetres = 0.1f;  ///< all corners of boxes are multiples of it

    /// The standard room: 10 x 4 x 10 m with `boxes` boxes that stand or float in it.
    explicit BoxRoom(int boxes, std::uint32_t seed = 1) : size_{10, 4, 10} {
        std::mt19937 random(seed);
        std::uniform_real_distribution<float> uniform;
        for (int i = 0; i < boxes; ++i) {
            const glm::vec3 extent =
                0.3f + 1.5f * glm::vec3{uniform(random), uniform(random), uniform(random)};
            glm::vec3 low = (size_ - extent) * glm::vec3{uniform(random), uniform(random), uniform(random)};
            if (i % 2 == 0) low.y = 0;
            const auto snap = [](glm::vec3 p) { return glm::round(p / kVoxelMetres) * kVoxelMetres; };
            boxes_.push_back({snap(low), snap(low + extent)});
        }
    }

    /// Nothing but what is added, and a ray may end nowhere. `size`: what makeRoomField fills with probes.
    static BoxRoom underSky(glm::vec3 size) {
        BoxRoom room(0);
        room.size_ = size;
        room.hasWalls_ = false;
        return room;
    }

    void add(const Box& box) { boxes_.push_back(box); }
    glm::vec3 size() const { return size_; }
    const std::vector<Box>& boxes() const { return boxes_; }

    bool isSolid(glm::vec3 p) const {
        for (const Box& box : boxes_)
            if (glm::all(glm::greaterThan(p, box.min)) && glm::all(glm::lessThan(p, box.max))) return true;
        if (!hasWalls_) return false;
        return glm::any(glm::lessThan(p, glm::vec3{0})) || glm::any(glm::greaterThan(p, size_));
    }

    RoomHit trace(glm::vec3 origin, glm::vec3 direction) const {
        RoomHit hit;
        for (int axis = 0; axis < 3 && hasWalls_; ++axis) {
            if (direction[axis] == 0) continue;
            const float wall = direction[axis] > 0 ? size_[axis] : 0;
            keep(hit, (wall - origin[axis]) / direction[axis], axis, direction, 0);
        }
        for (std::size_t i = 0; i < boxes_.size(); ++i)
            traceBox(hit, static_cast<int>(i) + 1, origin, direction);
        return hit;
    }

  private:
    static void keep(RoomHit& hit, float t, int axis, glm::vec3 direction, int surface) {
        if (!(t >= 0) || t >= hit.distance) return;
        hit.distance = t;
        hit.normal = glm::vec3{0};
        hit.normal[axis] = direction[axis] > 0 ? -1.0f : 1.0f;
        hit.surface = surface;
    }

    void traceBox(RoomHit& hit, int surface, glm::vec3 origin, glm::vec3 direction) const {
        const Box& box = boxes_[static_cast<std::size_t>(surface) - 1];
        float enter = -std::numeric_limits<float>::infinity();
        float leave = std::numeric_limits<float>::infinity();
        int axis = 0;
        for (int a = 0; a < 3; ++a) {
            float near = (box.min[a] - origin[a]) / direction[a];
            float far = (box.max[a] - origin[a]) / direction[a];
            if (near > far) std::swap(near, far);
            if (near > enter) {
                enter = near;
                axis = a;
            }
            leave = std::min(leave, far);
        }
        if (enter < leave) keep(hit, enter, axis, direction, surface);
    }

    glm::vec3 size_;
    bool hasWalls_ = true;
    std::vector<Box> boxes_;
};

/// The packed depth and normal map of a probe.
inline std::vector<std::uint32_t> traceDepthNormal(const BoxRoom& room, glm::vec3 probe, std::uint32_t edge,
                                                   const DepthCoder& coder) {
    std::vector<std::uint32_t> words;
    words.reserve(std::size_t{edge} * edge);
    for (std::uint32_t y = 0; y < edge; ++y)
        for (std::uint32_t x = 0; x < edge; ++x) {
            const RoomHit hit = room.trace(probe, directionOfTexel(x, y, edge));
            const bool sees = std::isfinite(hit.distance);
            words.push_back(sees ? packDepthNormal(coder.encode(hit.distance), hit.normal) : kDepthMissCode);
        }
    return words;
}

}  // namespace pfvox::test
