// Any bytes as a PF_VOX file. Hashes would stop nearly every mutation at the door, so the bytes are taken
// once as they are and once as the changes to make behind the repaired hashes of a small valid file.
#include <pfvox/pf_vox.hpp>

#include "support/pf_vox_surgery.hpp"
#include "support/voxel_models.hpp"

namespace {

using namespace pfvox;

void decode(std::span<const std::byte> bytes) {
    DiagnosticList diagnostics;
    const auto asset = decodePfVox(bytes, Limits{.maxMemoryBytes = 64 << 20}, diagnostics);
    if (!asset) return;
    // Whatever was accepted can be walked and written again.
    for (const OctreeModel& model : asset->models)
        static_cast<void>(statistics(model, asset->materials.size()));
    if (!encodePfVox(*asset, {})) std::abort();
}

const test::OpenFile& sample() {
    static const test::OpenFile open = [] {
        std::vector<VoxelModel> models;
        models.push_back(test::patchyModel(11, 20));
        models.push_back(test::boxModel({250, 0, 0}, {262, 10, 3}, 1));
        return test::openFile(
            encodePfVox(buildOctrees(test::assetOf(std::move(models)), Limits{}).value(), {}).value());
    }();
    return open;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    decode(std::as_bytes(std::span(data, size)));
    // Triples of section, place and value.
    test::OpenFile open = sample();
    for (std::size_t i = 0; i + 4 <= size && i < 400; i += 4) {
        test::OpenFile::Part& part = open.parts[data[i] % open.parts.size()];
        if (part.raw.empty()) continue;
        part.raw[(data[i + 1] | std::size_t{data[i + 2]} << 8) % part.raw.size()] = data[i + 3];
    }
    decode(test::closeFile(std::move(open)));
    return 0;
}
