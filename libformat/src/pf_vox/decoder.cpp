// The public face of reading: decodePfVox, loadPfVox, readPfVoxHeader, validatePfVox.
#include <fmt/format.h>
#include <pfvox/pf_vox.hpp>

#include "container/file_head.hpp"
#include "container/findings.hpp"
#include "guarded.hpp"
#include "io/files.hpp"
#include "pf_vox/asset_reader.hpp"

namespace pfvox {

std::string ContentKey::hex() const {
    std::string text;
    for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
    return text;
}

std::vector<std::string> PfVoxHeader::featureNames() const {
    std::vector<std::string> names;
    const auto add = [&](std::uint32_t features, std::uint32_t known, const char* name) {
        for (std::uint32_t bit = 0; bit < 32; ++bit) {
            if (((features >> bit) & 1u) == 0) continue;
            names.push_back((known >> bit & 1u) != 0 ? name : fmt::format("bit {}", bit));
        }
    };
    add(requiredFeatures, kPfVoxResident, "resident");
    add(optionalFeatures, kPfVoxHollow, "hollow");
    return names;
}

Result<OctreeAsset> decodePfVox(std::span<const std::byte> bytes, const Limits& limits,
                                Diagnostics& diagnostics) {
    return guarded([&]() -> Result<OctreeAsset> {
        ReadOutcome outcome = readAsset(bytes, limits, FaultPolicy::StopAtFirst, diagnostics);
        if (!outcome.faults.empty()) return tl::make_unexpected(std::move(outcome.faults.front()));
        return std::move(outcome.asset);
    });
}

Result<OctreeAsset> loadPfVox(const std::filesystem::path& file, const Limits& limits,
                              Diagnostics& diagnostics) {
    PFVOX_TRY(const io::FileBytes, contents, io::readFile(file, limits.maxFileBytes));
    auto asset = decodePfVox(contents.bytes(), limits, diagnostics);
    if (!asset) asset.error().file = file;
    return asset;
}

namespace {

Result<PfVoxHeader> readHeader(std::span<const std::byte> bytes) {
    container::MemoryBudget budget(2 * bytes.size());  // more than all tables it can hold
    PFVOX_TRY(const auto, head,
              container::readHead(container::MemorySource(bytes), container::kPfVox, budget));
    PfVoxHeader header{.versionMajor = head.header.versionMajor,
                       .versionMinor = head.header.versionMinor,
                       .requiredFeatures = head.header.requiredFeatures,
                       .optionalFeatures = head.header.optionalFeatures,
                       .fileBytes = head.header.fileBytes,
                       .contentKey = {head.header.contentKey},
                       .sections = {}};
    header.sections.reserve(head.sections.size());
    for (const layout::Section& s : head.sections) {
        header.sections.push_back({.fourcc = std::string(s.fourcc.data(), s.fourcc.size()),
                                   .regionId = s.region,
                                   .codec = s.codec == layout::Codec::Zstd ? "zstd" : "raw",
                                   .offsetBytes = s.offset,
                                   .storedBytes = s.storedBytes,
                                   .rawBytes = s.rawBytes});
    }
    return header;
}

}  // namespace

Result<PfVoxHeader> readPfVoxHeader(std::span<const std::byte> bytes) {
    return guarded([&] { return readHeader(bytes); });
}

std::vector<Finding> validatePfVox(std::span<const std::byte> bytes, const Limits& limits) {
    return container::findingsOf([&]() -> Result<std::vector<Finding>> {
        DiagnosticList ignored;
        std::vector<Finding> findings;
        for (Error& fault : readAsset(bytes, limits, FaultPolicy::CollectAll, ignored).faults)
            findings.push_back(container::findingOf(std::move(fault)));
        return findings;
    });
}

}  // namespace pfvox
