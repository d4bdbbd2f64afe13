#include "probe-bake/reference_store.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <optional>
#include <pfvox/files.hpp>

namespace pfvox::tools {

namespace {

/// Changes with everything that makes references differ and is not in the line.
constexpr int kReferenceVersion = 3;
constexpr std::uint64_t kMaxReferenceBytes = std::uint64_t{1} << 31;

std::string hexOf(const ContentKey& key) {
    std::string text;
    for (const std::uint8_t byte : key.bytes) text += fmt::format("{:02x}", byte);
    return text;
}

std::string vectorText(const glm::dvec3& v) {
    return fmt::format("{} {} {}", v.x, v.y, v.z);
}

/// All but how many paths it has, which a number behind it says.
std::string lineOf(const std::string& scene, const Camera& camera, const VerifySettings& settings) {
    return fmt::format("pfvox reference {}: scene {}, from {}, to {}, fov {}, {} x {}, {} bounces, paths ",
                       kReferenceVersion, scene, vectorText(camera.position), vectorText(camera.target),
                       camera.fovYDegrees, settings.width, settings.height, settings.maxBounces);
}

std::optional<ReferencePicture> decode(std::span<const std::byte> bytes, const std::string& line,
                                       const VerifySettings& settings) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t lineEnd = text.find('\n');
    if (lineEnd == std::string_view::npos || !text.starts_with(line)) return std::nullopt;
    ReferencePicture picture{.width = settings.width, .height = settings.height, .even = {}, .odd = {}};
    const char* const numberEnd = text.data() + lineEnd;
    if (std::from_chars(text.data() + line.size(), numberEnd, picture.samples).ptr != numberEnd)
        return std::nullopt;
    const std::size_t pixels = std::size_t{settings.width} * settings.height;
    const std::size_t half = pixels * sizeof(glm::vec4);
    const std::span<const std::byte> sums = bytes.subspan(lineEnd + 1);
    if (sums.size() != 2 * half) return std::nullopt;
    picture.even.resize(pixels);
    picture.odd.resize(pixels);
    std::memcpy(picture.even.data(), sums.data(), half);
    std::memcpy(picture.odd.data(), sums.data() + half, half);
    return picture;
}

}  // namespace

ReferenceStore::ReferenceStore(std::filesystem::path folder, const ContentKey& scene)
    : folder_(std::move(folder)), scene_(hexOf(scene)) {}

std::filesystem::path ReferenceStore::fileOf(const NamedCamera& named, const VerifySettings& settings) const {
    return folder_ / fmt::format("{}-{}-{}x{}.reference", scene_.substr(0, 8), named.fileName, settings.width,
                                 settings.height);
}

ReferencePicture ReferenceStore::find(const NamedCamera& named, const VerifySettings& settings) const {
    if (folder_.empty()) return {};
    const auto stored = io::readFile(fileOf(named, settings), kMaxReferenceBytes);
    if (!stored) return {};
    return decode(stored->bytes(), lineOf(scene_, named.camera, settings), settings)
        .value_or(ReferencePicture{});
}

Result<void> ReferenceStore::keep(const NamedCamera& named, const VerifySettings& settings,
                                  const ReferencePicture& picture) const {
    if (folder_.empty()) return {};
    const std::string line = lineOf(scene_, named.camera, settings) + std::to_string(picture.samples) + "\n";
    std::vector<std::byte> bytes;
    const auto add = [&](std::span<const std::byte> part) {
        bytes.insert(bytes.end(), part.begin(), part.end());
    };
    add(std::as_bytes(std::span(line)));
    add(std::as_bytes(std::span(picture.even)));
    add(std::as_bytes(std::span(picture.odd)));
    return io::writeFileAtomically(fileOf(named, settings), bytes);
}

}  // namespace pfvox::tools
