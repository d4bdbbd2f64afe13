#include "import/vox/vox_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <map>

namespace pfvox::import::vox {

namespace {

/// Voxel coordinates are bytes, so a larger SIZE only moves the pivot; MagicaVoxel's world has this edge.
constexpr std::int32_t kMaxSize = 2048;
constexpr std::int32_t kMaxAddressableSize = 256;

/// Cameras beyond are of no use, and float32 hardly holds them.
constexpr double kMaxMetres = 1e30;

/// Chunks of renderer and editor state that pfvox has no use for.
constexpr std::array<std::string_view, 6> kSkippedIds{"rOBJ", "rLIT", "rAIR", "rLEN", "POST", "rDIS"};

class VoxFileReader {
  public:
    VoxFileReader(double voxelSizeMetres, const Limits& limits, Diagnostics& diagnostics)
        : voxelSizeMetres_(voxelSizeMetres), limits_(limits), diagnostics_(diagnostics) {}

    Result<VoxFile> read(std::span<const std::byte> bytes) {
        PFVOX_TRY(ChunkWalker, walker, ChunkWalker::open(bytes, diagnostics_));
        while (true) {
            PFVOX_TRY(std::optional<Chunk>, chunk, walker.next());
            if (!chunk) break;
            PFVOX_CHECK(readChunk(*chunk));
        }
        PFVOX_CHECK(finish());
        return std::move(file_);
    }

  private:
    Result<void> readChunk(Chunk& chunk) {
        using Handler = Result<void> (VoxFileReader::*)(Chunk&);
        static const std::map<std::string_view, Handler> handlers{
            {"PACK", &VoxFileReader::readPack},      {"SIZE", &VoxFileReader::readSize},
            {"XYZI", &VoxFileReader::readVoxels},    {"TDCZ", &VoxFileReader::refuseTeardown},
            {"RGBA", &VoxFileReader::readColors},    {"IMAP", &VoxFileReader::readIndexMap},
            {"MATL", &VoxFileReader::readMaterial},  {"MATT", &VoxFileReader::readOldMaterial},
            {"nTRN", &VoxFileReader::readSceneNode}, {"nGRP", &VoxFileReader::readSceneNode},
            {"nSHP", &VoxFileReader::readSceneNode}, {"LAYR", &VoxFileReader::readSceneLayer},
            {"rCAM", &VoxFileReader::readView},      {"NOTE", &VoxFileReader::readNotes},
            {"META", &VoxFileReader::readMeta},
        };
        if (const auto handler = handlers.find(chunk.id()); handler != handlers.end()) {
            return (this->*handler->second)(chunk);
        }
        if (std::ranges::find(kSkippedIds, chunk.id()) == kSkippedIds.end())
            ++unknownChunks_[printableId(chunk.id())];
        return {};
    }

    Result<void> readPack(Chunk& chunk) {
        PFVOX_TRY(const std::int32_t, count, chunk.readInt("the number of models"));
        packCount_ = count;
        return {};
    }

    Result<void> readSize(Chunk& chunk) {
        if (size_)
            return chunk.fail(ErrorCode::BadStructure, "follows another SIZE without an XYZI between them");
        glm::ivec3 size;
        for (int axis = 0; axis < 3; ++axis) {
            PFVOX_TRY(const std::int32_t, edge, chunk.readInt("the size"));
            if (edge < 0 || edge > kMaxSize) {
                return chunk.fail(
                    ErrorCode::BadValue,
                    fmt::format("edge {} of a model: 0 to {} voxels are possible", edge, kMaxSize));
            }
            size[axis] = edge;
        }
        if (std::max({size.x, size.y, size.z}) > kMaxAddressableSize) {
            warnAt(chunk, "vox-size-too-large",
                   fmt::format("SIZE is {} x {} x {}, but voxels can lie in the first {} of each axis only",
                               size.x, size.y, size.z, kMaxAddressableSize));
        }
        size_ = size;
        return {};
    }

    Result<void> readVoxels(Chunk& chunk) {
        if (!size_) return chunk.fail(ErrorCode::BadStructure, "comes without a SIZE before it");
        if (file_.models.size() >= limits_.maxModels) {
            return chunk.fail(
                ErrorCode::LimitExceeded,
                fmt::format("the file holds more than {} models (limit maxModels)", limits_.maxModels));
        }
        PFVOX_TRY(const std::uint32_t, count, chunk.readCount(kVoxelBytes, "the number of voxels"));
        PFVOX_TRY(const auto, voxels, chunk.readBytes(std::uint64_t{count} * kVoxelBytes, "the voxels"));
        file_.models.push_back({.size = *size_, .voxels = voxels, .offsetBytes = chunk.offsetBytes()});
        size_.reset();
        return {};
    }

    Result<void> refuseTeardown(Chunk& chunk) {
        return chunk.fail(
            ErrorCode::UnsupportedFeature,
            "this file was written by the game Teardown, with compressed voxels (TDCZ) that pfvox cannot "
            "read; load and save it with MagicaVoxel first");
    }

    Result<void> readColors(Chunk& chunk) {
        warnIfSeen(chunk, "");
        PFVOX_TRY(const Palette, palette, readPalette(chunk));
        file_.palette = palette;
        return {};
    }

    Result<void> readIndexMap(Chunk& chunk) {
        checkIndexMap(chunk, diagnostics_);
        return {};
    }

    Result<void> readMaterial(Chunk& chunk) {
        PFVOX_TRY(MaterialChunk, material, readMatl(chunk));
        return keepMaterial(chunk, std::move(material));
    }

    Result<void> readOldMaterial(Chunk& chunk) {
        PFVOX_TRY(MaterialChunk, material, readMatt(chunk));
        return keepMaterial(chunk, std::move(material));
    }

    Result<void> keepMaterial(const Chunk& chunk, MaterialChunk material) {
        warnIfSeen(chunk, fmt::format(" of material {}", material.paletteIndex));
        file_.materials[static_cast<std::size_t>(material.paletteIndex)] = std::move(material.record);
        return {};
    }

    Result<void> readSceneNode(Chunk& chunk) {
        PFVOX_TRY(Node, node, readNode(chunk));
        const std::int32_t id = node.id;
        const auto [entry, isNew] = file_.graph.nodes.insert_or_assign(id, std::move(node));
        if (!isNew) warnDuplicate(chunk, fmt::format(" of node {}", id));
        return {};
    }

    Result<void> readSceneLayer(Chunk& chunk) {
        PFVOX_TRY(const LayerRecord, layer, readLayer(chunk));
        const auto [entry, isNew] = file_.graph.layers.insert_or_assign(layer.id, layer);
        if (!isNew) warnDuplicate(chunk, fmt::format(" of layer {}", layer.id));
        return {};
    }

    Result<void> readView(Chunk& chunk) {
        PFVOX_TRY(std::optional<Camera>, camera, readCamera(chunk, voxelSizeMetres_));
        if (!camera) return {};
        if (glm::length(camera->position) + glm::length(camera->target) < kMaxMetres) {
            file_.cameras.push_back(std::move(*camera));
        } else {
            warnAt(chunk, "vox-camera-far", camera->name + " stands too far away to be kept");
        }
        return {};
    }

    Result<void> readNotes(Chunk& chunk) {
        PFVOX_TRY(const std::uint32_t, count, chunk.readCount(4, "the number of notes"));
        for (std::uint32_t row = 0; row < count; ++row) {
            PFVOX_TRY(const std::string_view, text, chunk.readString("a note"));
            if (!text.empty()) file_.notes.push_back(fmt::format("color row {}: {}", row, text));
        }
        return {};
    }

    Result<void> readMeta(Chunk& chunk) {
        PFVOX_TRY(const Dict, entries, chunk.readDict("the metadata"));
        for (const auto& [key, value] : entries.entries())
            file_.notes.push_back(fmt::format("{}: {}", key, value));
        return {};
    }

    Result<void> finish() {
        if (size_) {
            return fail(ErrorCode::BadStructure,
                        "the last chunk SIZE has no XYZI after it; the file is damaged");
        }
        if (packCount_ &&
            static_cast<std::int64_t>(*packCount_) != static_cast<std::int64_t>(file_.models.size())) {
            diagnostics_.warn("vox-pack-count", fmt::format("chunk PACK announces {} models, the file has {}",
                                                            *packCount_, file_.models.size()));
        }
        if (!unknownChunks_.empty()) {
            std::vector<std::string> counts;
            for (const auto& [id, count] : unknownChunks_)
                counts.push_back(fmt::format("{} ({})", id, count));
            diagnostics_.note("vox-unknown-chunks",
                              fmt::format("unknown chunks skipped: {}", fmt::join(counts, ", ")));
        }
        return {};
    }

    void warnAt(const Chunk& chunk, std::string id, std::string message) {
        diagnostics_.report({.severity = Severity::Warning,
                             .id = std::move(id),
                             .message = std::move(message),
                             .offsetBytes = chunk.offsetBytes()});
    }

    void warnDuplicate(const Chunk& chunk, const std::string& what) {
        warnAt(chunk, "vox-duplicate-chunk",
               fmt::format("another chunk {}{}: the last one counts", printableId(chunk.id()), what));
    }

    void warnIfSeen(const Chunk& chunk, const std::string& what) {
        if (!seen_.insert(std::string(chunk.id()) + what).second) warnDuplicate(chunk, what);
    }

    const double voxelSizeMetres_;
    const Limits& limits_;
    Diagnostics& diagnostics_;
    VoxFile file_;
    std::optional<glm::ivec3> size_;  ///< of the model whose XYZI is awaited
    std::optional<std::int32_t> packCount_;
    std::map<std::string, std::uint64_t> unknownChunks_;
    std::set<std::string> seen_;
};

}  // namespace

Result<VoxFile> readVoxFile(std::span<const std::byte> bytes, double voxelSizeMetres, const Limits& limits,
                            Diagnostics& diagnostics) {
    return VoxFileReader(voxelSizeMetres, limits, diagnostics).read(bytes);
}

}  // namespace pfvox::import::vox
