// The whole way, from a source that others made to pixels: importer, builder, encoder, decoder, GPU scene,
// picture.
//
// The goldens of the corpus models are pictures of models of the mmmm collection, CC BY 4.0
// (tests/image/golden/README.md).
#include <pfvox/convert.hpp>

#include "support/corpus.hpp"
#include "support/image_compare.hpp"
#include "support/picture_fixture.hpp"

namespace pfvox::test {
namespace {

Result<OctreeAsset> converted(const std::filesystem::path& source) {
    DiagnosticList diagnostics;
    PFVOX_TRY(const VoxelAsset, imported, importFile(source, {}, Limits{}, diagnostics));
    PFVOX_TRY(const OctreeAsset, built, buildOctrees(imported, Limits{}));
    PFVOX_TRY(const auto, bytes, encodePfVox(built, {}));
    return decodePfVox(bytes, Limits{}, diagnostics);
}

class SourcePicture : public PictureTest {
  protected:
    static void expectGolden(const std::filesystem::path& source, const std::string& name) {
        PFVOX_ASSERT_VALUE(const OctreeAsset, asset, converted(source));
        const viewer::PictureSettings settings{.width = 400, .height = 300, .lighting = {}};
        PFVOX_ASSERT_VALUE(const Shot, shot, draw(asset, settings));
        EXPECT_TRUE(matchesGolden(shot.picture, name));
        EXPECT_EQ(shot.statistics.stepLimitRays, 0u);
    }
    static std::filesystem::path corpus(const std::string& name) {
        return std::filesystem::path(PFVOX_CORPUS_DIR) / "vox" / name;
    }
};

TEST_F(SourcePicture, Store) {
    PFVOX_NEEDS_CORPUS("vox/mmmm/scene_store11.vox");
    expectGolden(corpus("mmmm/scene_store11.vox"), "source-store");
}

TEST_F(SourcePicture, House) {
    PFVOX_NEEDS_CORPUS("vox/mmmm/obj_house1c.vox");
    expectGolden(corpus("mmmm/obj_house1c.vox"), "source-house");
}

TEST_F(SourcePicture, Car) {
    PFVOX_NEEDS_CORPUS("vox/mmmm/veh_car5.vox");
    expectGolden(corpus("mmmm/veh_car5.vox"), "source-car");
}

TEST_F(SourcePicture, CourtyardOfThirtyRotatedAndMirroredInstances) {
    expectGolden(std::filesystem::path(PFVOX_DATA_DIR) / "courtyard.vox", "source-courtyard");
}

}  // namespace
}  // namespace pfvox::test
