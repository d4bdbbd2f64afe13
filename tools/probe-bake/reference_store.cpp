#include "probe-bake/reference_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <optional>
#include <pfvox/files.hpp>

namespace pfvox::tools {

namespace {

/// Changes with everything that makes references differ and is not in the line.
constexpr int kReferenceVersion = 2;
constexpr std::uint64_t kMaxReferenceBytes = std::uint64_t{1} << 31;

std::string hexOf(const ContentKey& key) {
    std::string text;
    for (const std::uint8_t byte : key.bytes) text += fmt::format("{:02x}", byte);
    return text;
}

std::string vectorText(const glm::dvec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

std::string lineOf(const std::string& scene, const Camera& camera, const VerifySettings& settings) {
    return fmt::format("pfvox reference {}: scene {}, from {}, to {}, fov {}, {} x {}, {} samples, {} bounces\n",
                       kReferenceVersion, scene, vectorText(camera.position), vectorText(camera.target),
                       camera.fovYDegrees, settings.width, settings.height, settings.samples, settings.maxBounces);
}

std::optional<ReferencePicture> decode(std::span<const std::byte> bytes, const std::string& line,
                                       const VerifySettings& settings) {
    const std::size_t pixels = std::size_t{settings.width} * settings.height;
    const std::size_t half = pixels * sizeof(glm::vec4);
    if (bytes.size() != line.size() + 2 * half || std::memcmp(bytes.data(), line.data(), line.size()) != 0)
        return std::nullopt;
    ReferencePicture picture{.width = settings.width, .height = settings.height, .even = {}, .odd = {}};
    picture.even.resize(pixels);
    picture.odd.resize(pixels);
    std::memcpy(picture.even.data(), bytes.data() + line.size(), half);
    std::memcpy(picture.odd.data(), bytes.data() + line.size() + half, half);
    return picture;
}

Result<void> keep(const std::filesystem::path& file, const std::string& line, const ReferencePicture& picture) {
    std::vector<std::byte> bytes;
    const auto add = [&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); };
    add(std::as_bytes(std::span(line)));
    add(std::as_bytes(std::span(picture.even)));
    add(std::as_bytes(std::span(picture.odd)));
    return io::writeFileAtomically(file, bytes);
}

}  // namespace

ReferenceStore::ReferenceStore(std::filesystem::path folder, const ContentKey& scene)
    : folder_(std::move(folder)), scene_(hexOf(scene)) {}

Result<ReferencePicture> ReferenceStore::fetch(const Camera& camera, const VerifySettings& settings,
                                               const std::function<Result<ReferencePicture>()>& trace) const {
    if (folder_.empty()) return trace();
    const std::string line = lineOf(scene_, camera, settings);
    std::string name = camera.name.empty() ? "camera" : camera.name;
    std::ranges::replace_if(name, [](unsigned char c) { return std::isalnum(c) == 0 && c != '-' && c != '_'; }, '_');
    const std::filesystem::path file =
        folder_ / fmt::format("{}-{}-{}x{}-{}.reference", scene_.substr(0, 8), name, settings.width, settings.height,
                              settings.samples);
    if (const auto stored = io::readFile(file, kMaxReferenceBytes)) {
        if (auto picture = decode(stored->bytes(), line, settings)) return *std::move(picture);
    }
    PFVOX_TRY(ReferencePicture, picture, trace());
    PFVOX_CHECK(keep(file, line, picture));
    return picture;
}

}  // namespace pfvox::tools
