#include <fmt/format.h>
#include <chrono>
#include <pfvox/convert.hpp>
#include <pfvox/hollow.hpp>

#include "guarded.hpp"
#include "io/files.hpp"
#include "io/hash.hpp"
#include "octree/lanes.hpp"

namespace pfvox {

namespace {

/// Seconds since the last call.
class Stopwatch {
  public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const std::chrono::duration<double> passed = now - last_;
        last_ = now;
        return passed.count();
    }

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

Error withFile(Error error, const std::filesystem::path& file) {
    if (error.file.empty()) error.file = file;
    return error;
}

// One spelling for one value.

template <class T>
requires std::is_arithmetic_v<T> std::string spelled(T value) {
    return fmt::format("{}", value);
}
template <class Enum>
requires std::is_enum_v<Enum> std::string spelled(Enum value) {
    return fmt::format("{}", static_cast<int>(value));
}
std::string spelled(const std::optional<double>& value) {
    return value ? spelled(*value) : "source";
}
std::string spelled(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += fmt::format("{}:{},", name.size(), name);
    return text;
}

}  // namespace

ConvertReport countsOf(const OctreeAsset& asset) {
    ConvertReport report;
    report.models = static_cast<std::uint32_t>(asset.models.size());
    report.instances = static_cast<std::uint32_t>(asset.instances.size());
    report.materials = static_cast<std::uint32_t>(asset.materials.size());
    for (const OctreeModel& model : asset.models) {
        report.voxels += model.voxelCount;
        report.nodes += model.topTree.nodes.size();
        for (const OctreeRegion& region : model.regions) {
            report.nodes += region.tree.nodes.size();
            for (const std::uint32_t d : region.tree.nodes) {
                report.leaves += octree::kBitCount[node::leafMask(d)];
            }
        }
    }
    return report;
}

ContentKey contentKey(std::span<const std::byte> source, const ConvertSettings& settings) {
    io::Xxh3_128 hash;
    hash.update(fmt::format("{} revision {}", PFVOX_VERSION, kConverterRevision));
    hash.update(fmt::format("pf_vox {}.{}", kPfVoxVersionMajor, kPfVoxVersionMinor));
    forEachConvertSetting(
        [&](const ConvertSetting& setting, const auto& value) {
            hash.update(fmt::format(" {}={}", setting.key, spelled(value)));
        },
        settings);
    hash.update(source);
    return {hash.digest()};
}

Result<std::vector<std::byte>> convertBytes(std::span<const std::byte> bytes,
                                            const std::filesystem::path& source,
                                            const ConvertSettings& settings, const Limits& limits,
                                            Diagnostics& diagnostics, ConvertReport& report) {
    Stopwatch watch;
    ConvertReport before{.sourceBytes = bytes.size()};  // the build
    const auto built = guarded([&]() -> Result<OctreeAsset> {
        PFVOX_TRY(VoxelAsset, asset, importBytes(bytes, source, settings.import, limits, diagnostics));
        compactMaterials(asset);
        before.importSeconds = watch.lap();
        if (settings.hollow) {
            before.hollowedVoxels = hollowSolids(asset).hiddenVoxels;
            compactMaterials(asset);  // some were only inside
        }
        return buildOctrees(asset, limits, settings.build);
    });
    if (!built) return tl::make_unexpected(withFile(built.error(), source));
    report = countsOf(*built);
    report.sourceBytes = before.sourceBytes;
    report.hollowedVoxels = before.hollowedVoxels;
    report.importSeconds = before.importSeconds;
    report.buildSeconds = watch.lap();

    const EncodeSettings encode{.zstdLevel = settings.zstdLevel,
                                .contentKey = contentKey(bytes, settings),
                                .profile = settings.profile};
    auto encoded = encodePfVox(*built, encode);
    if (!encoded) return tl::make_unexpected(withFile(std::move(encoded).error(), source));
    report.outputBytes = encoded->size();
    report.encodeSeconds = watch.lap();
    return encoded;
}

Result<ConvertReport> convertFile(const std::filesystem::path& source, const std::filesystem::path& output,
                                  const ConvertSettings& settings, const Limits& limits,
                                  Diagnostics& diagnostics) {
    ConvertReport report;
    PFVOX_TRY(const io::FileBytes, contents, io::readFile(source, limits.maxFileBytes));
    PFVOX_TRY(const auto, encoded,
              convertBytes(contents.bytes(), source, settings, limits, diagnostics, report));
    Stopwatch watch;
    PFVOX_CHECK(io::writeFileAtomically(output, encoded));
    report.writeSeconds = watch.lap();
    return report;
}

}  // namespace pfvox
