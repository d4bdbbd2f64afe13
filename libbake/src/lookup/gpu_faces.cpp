#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <pfvox/gpu_faces.hpp>

#include "scene/face_table.hpp"
#include "shared/faces.glsl.h"

namespace pfvox::gpu {

namespace {

/// What the device has for each face, and behind it those of divided faces.
struct Words {
    std::vector<std::uint32_t> faces;
    std::vector<std::uint32_t> parts;
    std::vector<glm::vec3> means;  ///< of each face
    std::vector<std::uint8_t> known;
    std::uint64_t divided = 0;
};

Result<Words> wordsOf(const FaceValues& light) {
    Words words;
    const std::size_t faces = light.levels.size();
    words.faces.resize(faces, shared::kFaceNoValue);
    words.means.resize(faces);
    std::size_t next = 0;
    for (std::size_t face = 0; face < faces; ++face) {
        const std::uint32_t level = light.levels[face];
        if (level == kNoFaceValue) continue;
        const std::size_t count = std::size_t{1} << (2 * level);
        if (level > shared::kMaxFaceLevel || next + count > light.values.size())
            return fail(ErrorCode::BadStructure, "light of faces has other values than its levels say");
        if (level == 0) {
            words.faces[face] = light.values[next];
            words.means[face] = shared::unpackRgb9e5(light.values[next]);
        } else {
            const std::uint64_t at = words.parts.size() / 4;
            if (at > shared::kFacePartMask)
                return fail(ErrorCode::GpuOutOfMemory,
                            "more faces are divided than the device's words can count");
            words.faces[face] =
                shared::kFaceEscape | level << shared::kFaceLevelShift | static_cast<std::uint32_t>(at);
            ++words.divided;
            glm::vec3 sum(0.0f);
            for (std::size_t i = 0; i < count; ++i) {
                words.parts.push_back(light.values[next + i]);
                sum += shared::unpackRgb9e5(light.values[next + i]);
            }
            words.means[face] = sum / static_cast<float>(count);
        }
        next += count;
    }
    if (next != light.values.size())
        return fail(ErrorCode::BadStructure, "light of faces has other values than its levels say");
    return words;
}

/// Sums over the faces of a node, by direction.
struct NodeSum {
    std::array<glm::vec3, 6> light{};
    std::array<float, 6> faces{};

    void add(const NodeSum& other) {
        for (std::size_t d = 0; d < 6; ++d) {
            light[d] += other.light[d];
            faces[d] += other.faces[d];
        }
    }
};

class MeanMaker {
  public:
    MeanMaker(const detail::FaceTable& table, const Words& words, std::uint32_t firstFace,
              std::span<std::uint32_t> out)
        : table_(table), words_(words), firstFace_(firstFace), out_(out) {}

    void run() {
        std::vector<NodeSum> open;  // nobody's yet
        for (const detail::FaceNode& node : table_.nodes) {
            NodeSum sum;
            if (node.children == 0) {
                sum = sumOf(node);
            } else {
                for (std::uint32_t i = 0; i < node.children; ++i) {
                    sum.add(open.back());
                    open.pop_back();
                }
            }
            if (node.squares == 0) write(node, sum);
            open.push_back(sum);
        }
    }

  private:
    void addFaces(NodeSum& sum, std::size_t direction, std::uint32_t first, std::uint32_t count) const {
        for (std::uint32_t face = firstFace_ + first; face < firstFace_ + first + count; ++face) {
            if (words_.faces[face] == shared::kFaceNoValue) continue;
            sum.light[direction] += words_.means[face];
            sum.faces[direction] += 1.0f;
        }
    }

    NodeSum sumOf(const detail::FaceNode& node) const {
        NodeSum sum;
        std::uint32_t slot = node.slot;
        std::uint32_t face = node.firstFace;
        for (std::size_t d = 0; d < 6; ++d) {
            if ((node.directions >> d & 1u) == 0) continue;
            if (node.squares == 0) {
                const glm::uvec2 mask = table_.slots[slot++];
                const auto count = static_cast<std::uint32_t>(std::popcount(mask.x) + std::popcount(mask.y));
                addFaces(sum, d, face, count);
                face += count;
                continue;
            }
            for (std::uint32_t i = 0; i < node.squares; ++i) {
                const glm::uvec2 square = table_.slots[slot++];
                addFaces(sum, d, face + square.y, static_cast<std::uint32_t>(std::popcount(square.x)));
            }
        }
        return sum;
    }

    void write(const detail::FaceNode& node, const NodeSum& sum) const {
        std::uint32_t slot = node.slot;
        for (std::size_t d = 0; d < 6; ++d) {
            if ((node.directions >> d & 1u) == 0) continue;
            out_[slot++] =
                sum.faces[d] > 0.0f ? shared::packRgb9e5(sum.light[d] / sum.faces[d]) : shared::kFaceNoValue;
        }
    }

    const detail::FaceTable& table_;
    const Words& words_;
    std::uint32_t firstFace_;
    std::span<std::uint32_t> out_;
};

Result<Buffer> bufferOf(Device& device, std::span<const std::uint32_t> words, std::string_view name) {
    PFVOX_TRY(Buffer, buffer, device.createBuffer(std::max<std::uint64_t>(words.size_bytes(), 4), name));
    if (!words.empty()) PFVOX_CHECK(device.upload(buffer, 0, std::as_bytes(words)));
    return buffer;
}

}  // namespace

Result<GpuFaces> GpuFaces::upload(Device& device, const Scene& scene, const FaceValues& light) {
    if (light.levels.size() != scene.faceCount())
        return fail(ErrorCode::BadStructure, fmt::format("there is light for {} faces, and the scene has {}",
                                                         light.levels.size(), scene.faceCount()));
    PFVOX_TRY(const Words, words, wordsOf(light));
    std::uint64_t meanCount = 0;
    for (const PlacedFaces& placed : scene.faces()) meanCount += placed.table->slots.size();
    std::vector<std::uint32_t> means(meanCount, shared::kFaceNoValue);
    tbb::parallel_for(std::size_t{0}, scene.faces().size(), [&](std::size_t i) {
        const PlacedFaces& placed = scene.faces()[i];
        const auto own = std::span(means).subspan(placed.firstMean, placed.table->slots.size());
        MeanMaker(*placed.table, words, placed.firstFace, own).run();
    });
    PFVOX_TRY(Buffer, table, device.createBuffer(sizeof(shared::FaceField), "light of faces"));
    PFVOX_TRY(Buffer, values, bufferOf(device, words.faces, "values of faces"));
    PFVOX_TRY(Buffer, parts, bufferOf(device, words.parts, "values of divided faces"));
    PFVOX_TRY(Buffer, meanWords, bufferOf(device, means, "means of faces"));
    const shared::FaceField record{.values = values.addressWords(),
                                   .parts = parts.addressWords(),
                                   .means = meanWords.addressWords(),
                                   .reserved0 = 0,
                                   .reserved1 = 0};
    PFVOX_CHECK(device.upload(table, 0, bytesOf(record)));
    PFVOX_CHECK(device.flush());
    GpuFaces faces(std::move(table), std::move(values), std::move(parts), std::move(meanWords));
    faces.statistics_ = {.faces = light.levels.size(),
                         .divided = words.divided,
                         .values = light.values.size(),
                         .valueBytes = 4 * (words.faces.size() + words.parts.size()),
                         .meanBytes = 4 * means.size()};
    return faces;
}

}  // namespace pfvox::gpu
