#include <tbb/parallel_for.h>

#include <map>
#include <mutex>
#include <optional>
#include <pfvox/assert.hpp>
#include <pfvox/face_file.hpp>

namespace pfvox {

namespace {

/// Numbers of faces in file order, region by region, of a model that several instances may share.
class FileOrders {
  public:
    const std::vector<std::uint32_t>& of(const FaceIndex& index, std::size_t region) {
        const auto [entry, added] = known_.try_emplace({&index, region});
        if (added) entry->second = index.fileOrder(region);
        return entry->second;
    }

  private:
    std::map<std::pair<const FaceIndex*, std::size_t>, std::vector<std::uint32_t>> known_;
};

/// Where the values of each face begin, and the end.
std::vector<std::uint64_t> firstValues(std::span<const std::uint8_t> levels) {
    std::vector<std::uint64_t> first(levels.size() + 1);
    for (std::size_t i = 0; i < levels.size(); ++i) first[i + 1] = first[i] + faceValuesOf(levels[i]);
    return first;
}

}  // namespace

std::vector<FaceInstance> faceInstancesOf(const gpu::Scene& scene) {
    std::map<const FaceIndex*, FaceInstance> known;
    std::vector<FaceInstance> instances;
    for (const gpu::PlacedFaces& placed : scene.faces()) {
        const auto [entry, added] = known.try_emplace(placed.index);
        if (added) entry->second = faceInstanceOf(*placed.index);
        instances.push_back(entry->second);
    }
    return instances;
}

std::vector<std::vector<std::uint32_t>> facesOfChunks(const gpu::Scene& scene, const FaceLightInfo& info) {
    const std::vector<FaceChunkPlace> places = faceChunkPlaces(info);
    std::vector<std::vector<std::uint32_t>> chunks(places.size());
    FileOrders orders;
    std::size_t chunk = 0;
    for (std::size_t i = 0; i < scene.faces().size(); ++i) {
        const gpu::PlacedFaces& placed = scene.faces()[i];
        for (std::size_t region = 0; region < placed.index->regions.size(); ++region) {
            const std::uint32_t first = placed.firstFace + placed.index->regions[region].firstFace;
            const std::vector<std::uint32_t>& order = orders.of(*placed.index, region);
            if (order.empty()) continue;
            while (chunk < places.size() && chunks[chunk].size() >= places[chunk].faceCount) ++chunk;
            PFVOX_ASSERT(chunk < places.size());
            for (const std::uint32_t face : order) chunks[chunk].push_back(first + face);
        }
    }
    return chunks;
}

std::vector<FaceChunk> faceChunks(const gpu::Scene& scene, const FaceLightInfo& info,
                                  const FaceValues& light) {
    const std::vector<std::vector<std::uint32_t>> faces = facesOfChunks(scene, info);
    const std::vector<std::uint64_t> first = firstValues(light.levels);
    std::vector<FaceChunk> chunks(faces.size());
    tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t i) {
        for (const std::uint32_t face : faces[i]) {
            chunks[i].levels.push_back(light.levels[face]);
            for (std::uint64_t v = first[face]; v < first[face + std::size_t{1}]; ++v)
                chunks[i].values.push_back(light.values[v]);
        }
    });
    return chunks;
}

FaceValues faceValues(const gpu::Scene& scene, const FaceLightInfo& info, std::span<const FaceChunk> chunks) {
    const std::vector<std::vector<std::uint32_t>> faces = facesOfChunks(scene, info);
    FaceValues light;
    light.levels.resize(scene.faceCount());
    for (std::size_t i = 0; i < faces.size(); ++i)
        for (std::size_t k = 0; k < faces[i].size(); ++k) light.levels[faces[i][k]] = chunks[i].levels[k];
    const std::vector<std::uint64_t> first = firstValues(light.levels);
    light.values.resize(first.back());
    tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t i) {
        std::size_t next = 0;
        for (const std::uint32_t face : faces[i])
            for (std::uint64_t v = first[face]; v < first[face + std::size_t{1}]; ++v)
                light.values[v] = chunks[i].values[next++];
    });
    return light;
}

Result<FaceValues> readFaceValues(const ProbeFileReader& reader, const gpu::Scene& scene) {
    const FaceLightInfo& info = *reader.faces();
    if (info.instances != faceInstancesOf(scene))
        return fail(ErrorCode::BadReference, "its light on faces is that of other models");
    const std::size_t count = faceChunkPlaces(info).size();
    if (info.range != FaceChunkRange{0, static_cast<std::uint32_t>(count)})
        return fail(ErrorCode::BadReference,
                    "its light on faces is a part of the whole: merge the parts first");
    std::vector<FaceChunk> chunks(count);
    std::mutex mutex;
    std::optional<Error> error;
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        Result<FaceChunk> read = reader.readFaceChunk(static_cast<std::uint32_t>(i));
        if (read) {
            chunks[i] = *std::move(read);
            return;
        }
        const std::scoped_lock lock(mutex);
        if (!error) error = read.error();
    });
    if (error) return tl::make_unexpected(*error);
    return faceValues(scene, info, chunks);
}

}  // namespace pfvox
