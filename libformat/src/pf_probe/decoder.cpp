// decodePfProbe, loadPfProbe and validation: all of a file, by the reader that also reads single probes.
#include <fmt/format.h>

#include <algorithm>
#include <pfvox/probe_file.hpp>

#include "container/findings.hpp"
#include "pf_probe/records.hpp"
#include "shared/probe_maths.glsl.h"

namespace pfvox {

namespace {

using container::findingOf;

/// What the layers of one probe say about each other.
class ProbeCheck {
  public:
    ProbeCheck(const ProbeResolution& resolution, const ProbeData& data)
        : resolution_(resolution), data_(data) {}

    Result<void> minDepth() const {
        const std::uint32_t edge = resolution_.edgeOf(ProbeLayer::MinDepth);
        for (std::uint32_t i = 0; i < edge * edge; ++i) {
            const std::uint32_t smallest = smallestCode(i % edge, i / edge);
            if (data_.minDepth[i] != smallest) {
                return fail(ErrorCode::BadStructure,
                            fmt::format("texel {} is {}, but the smallest code of its block is {}", i,
                                        data_.minDepth[i], smallest));
            }
        }
        return {};
    }

    Result<void> border(const std::vector<std::uint32_t>& words, std::uint32_t interior) const {
        const std::uint32_t edge = interior + 2;
        for (std::uint32_t i = 0; i < edge * edge; ++i) {
            const glm::ivec2 source = shared::borderSource(
                {static_cast<int>(i % edge), static_cast<int>(i / edge)}, static_cast<int>(interior));
            const auto from =
                static_cast<std::uint32_t>(source.x + 1) + edge * static_cast<std::uint32_t>(source.y + 1);
            if (words[i] != words[from])
                return fail(ErrorCode::BadStructure,
                            fmt::format("border texel {} does not repeat texel {}", i, from));
        }
        return {};
    }

  private:
    std::uint32_t smallestCode(std::uint32_t blockX, std::uint32_t blockY) const {
        std::uint32_t smallest = shared::kDepthMiss;
        for (std::uint32_t y = blockY * shared::kMinDepthBlock; y < (blockY + 1) * shared::kMinDepthBlock;
             ++y)
            for (std::uint32_t x = blockX * shared::kMinDepthBlock; x < (blockX + 1) * shared::kMinDepthBlock;
                 ++x)
                smallest =
                    std::min(smallest, shared::depthCodeOf(data_.depthNormal[x + resolution_.depth * y]));
        return smallest;
    }

    const ProbeResolution& resolution_;
    const ProbeData& data_;
};

class Validation {
  public:
    explicit Validation(const ProbeFileReader& reader) : reader_(reader) {}

    std::vector<Finding> run() {
        const ProbeRange range = reader_.info().range;
        for (std::uint32_t probe = range.first;
             probe < range.end && findings_.size() < container::kMaxFindings; ++probe)
            checkProbe(probe);
        const FaceChunkRange chunks = reader_.faces() ? reader_.faces()->range : FaceChunkRange{};
        for (std::uint32_t chunk = chunks.first;
             chunk < chunks.end && findings_.size() < container::kMaxFindings; ++chunk)
            if (auto light = reader_.readFaceChunk(chunk); !light)
                findings_.push_back(findingOf(std::move(light).error()));
        return std::move(findings_);
    }

  private:
    void note(Result<void> result, std::uint32_t probe, ProbeLayer layer) {
        if (result) return;
        Error& error = result.error();
        if (!error.offsetBytes) error.offsetBytes = reader_.frame(probe, layer).offsetBytes;
        if (error.context.empty()) error.context = fmt::format("{} of probe {}", toString(layer), probe);
        findings_.push_back(findingOf(error));
    }

    void checkProbe(std::uint32_t probe) {
        if (!reader_.record(probe).isActive()) return;
        const ProbeResolution& resolution = reader_.info().resolution;
        const std::size_t before = findings_.size();
        ProbeData data{.record = reader_.record(probe)};
        for (const ProbeLayer layer : probe::kAllLayers) {
            if (!resolution.has(layer)) continue;
            note(reader_.readLayer(probe, layer, data.resizeLayer(layer, resolution.bytesOf(layer))), probe,
                 layer);
        }
        if (findings_.size() != before) return;
        if (const auto checked = checkProbeData(reader_.info(), probe, data); !checked)
            findings_.push_back(findingOf(checked.error()));
        const ProbeCheck check(resolution, data);
        if (resolution.depth != 0) note(check.minDepth(), probe, ProbeLayer::MinDepth);
        if (resolution.irradiance != 0)
            note(check.border(data.irradiance, resolution.irradiance), probe, ProbeLayer::Irradiance);
        if (resolution.moments != 0)
            note(check.border(data.moments, resolution.moments), probe, ProbeLayer::Moments);
    }

    const ProbeFileReader& reader_;
    std::vector<Finding> findings_;
};

template <class Open>
std::vector<Finding> validate(const Open& open) {
    return container::findingsOf([&]() -> Result<std::vector<Finding>> {
        DiagnosticList ignored;
        PFVOX_TRY(const ProbeFileReader, reader, open(ignored));
        return Validation(reader).run();
    });
}

}  // namespace

Result<ProbeField> decodePfProbe(std::span<const std::byte> bytes, const Limits& limits,
                                 Diagnostics& diagnostics) {
    PFVOX_TRY(const ProbeFileReader, reader, ProbeFileReader::overBytes(bytes, limits, diagnostics));
    return reader.readField();
}

Result<ProbeField> loadPfProbe(const std::filesystem::path& file, const Limits& limits,
                               Diagnostics& diagnostics) {
    PFVOX_TRY(const ProbeFileReader, reader, ProbeFileReader::open(file, limits, diagnostics));
    auto field = reader.readField();
    if (!field) field.error().file = file;
    return field;
}

std::vector<Finding> validatePfProbe(std::span<const std::byte> bytes, const Limits& limits) {
    return validate([&](Diagnostics& ignored) { return ProbeFileReader::overBytes(bytes, limits, ignored); });
}

std::vector<Finding> validatePfProbeFile(const std::filesystem::path& file, const Limits& limits) {
    return validate([&](Diagnostics& ignored) { return ProbeFileReader::open(file, limits, ignored); });
}

}  // namespace pfvox
