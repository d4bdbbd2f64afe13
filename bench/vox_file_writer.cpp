#include "vox_file_writer.hpp"

#include <bit>

namespace pfvox::bench {

namespace {

constexpr std::int32_t kVersion = 150;
constexpr std::size_t kMainChildrenOffset = 16;  // of MAIN's size of children
constexpr std::size_t kFirstChunkOffset = 20;

std::string translationText(glm::ivec3 t) {
    return std::to_string(t.x) + ' ' + std::to_string(t.y) + ' ' + std::to_string(t.z);
}

}  // namespace

VoxFileWriter::VoxFileWriter(const std::filesystem::path& path) {
    file_.exceptions(std::ios::failbit | std::ios::badbit);
    file_.open(path, std::ios::binary | std::ios::trunc);
    file_.write("VOX ", 4);
    int32(kVersion);
    chunk("MAIN", 0);
}

void VoxFileWriter::int32(std::int32_t value) {
    static_assert(std::endian::native == std::endian::little);
    file_.write(reinterpret_cast<const char*>(&value), sizeof value);
}

void VoxFileWriter::chunk(const char* id, std::size_t contentBytes) {
    file_.write(id, 4);
    int32(static_cast<std::int32_t>(contentBytes));
    int32(0);
}

void VoxFileWriter::text(const std::string& s) {
    int32(static_cast<std::int32_t>(s.size()));
    file_.write(s.data(), static_cast<std::streamsize>(s.size()));
}

int VoxFileWriter::addModel(glm::ivec3 size, std::span<const VoxVoxel> voxels) {
    chunk("SIZE", 12);
    for (int axis = 0; axis < 3; ++axis) int32(size[axis]);
    chunk("XYZI", 4 + voxels.size_bytes());
    int32(static_cast<std::int32_t>(voxels.size()));
    file_.write(reinterpret_cast<const char*>(voxels.data()),
                static_cast<std::streamsize>(voxels.size_bytes()));
    return modelCount_++;
}

void VoxFileWriter::addInstance(int model, glm::ivec3 translation) {
    instances_.push_back({model, translation});
}

void VoxFileWriter::writeGraph() {
    // 0 = root transform, 1 = group, then a transform and a shape for each instance.
    const auto instanceNode = [](std::size_t i) { return static_cast<std::int32_t>(2 + 2 * i); };
    chunk("nTRN", 28);
    for (const int v : {0, 0, 1, -1, -1, 1, 0}) int32(v);
    chunk("nGRP", 12 + 4 * instances_.size());
    for (const int v : {1, 0, static_cast<int>(instances_.size())}) int32(v);
    for (std::size_t i = 0; i < instances_.size(); ++i) int32(instanceNode(i));
    for (std::size_t i = 0; i < instances_.size(); ++i) {
        const std::string place = translationText(instances_[i].translation);
        chunk("nTRN", 28 + 4 + 2 + 4 + place.size());
        for (const int v : {instanceNode(i), 0, instanceNode(i) + 1, -1, 0, 1, 1}) int32(v);
        text("_t");
        text(place);
        chunk("nSHP", 20);
        for (const int v : {instanceNode(i) + 1, 0, 1, instances_[i].model, 0}) int32(v);
    }
}

void VoxFileWriter::writePalette() {
    chunk("RGBA", 1024);
    for (std::uint32_t i = 0; i < 256; ++i) {
        int32(static_cast<std::int32_t>(0xff000000u | (i * 0x010306u + 0x102030u)));
    }
}

void VoxFileWriter::finishWithSelfCycle() {
    instances_.clear();
    chunk("nTRN", 28);
    for (const int v : {0, 0, 0, -1, -1, 1, 0}) int32(v);
    finish();
}

void VoxFileWriter::finish() {
    if (!instances_.empty()) writeGraph();
    writePalette();
    const auto end = static_cast<std::size_t>(file_.tellp());
    file_.seekp(kMainChildrenOffset);
    int32(static_cast<std::int32_t>(end - kFirstChunkOffset));
    file_.close();
}

}  // namespace pfvox::bench
