// Random scenes: whatever the graph, sizes, rotations and mirrors, the importer and the independent reader
// agree on every world cell.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <random>

#include "support/import_bytes.hpp"
#include "support/independent_vox_reader.hpp"
#include "support/vox_asset_cells.hpp"
#include "support/vox_writer.hpp"

namespace pfvox {
namespace {

using test::VoxVoxel;
using test::VoxWriter;

constexpr int kScenes = 300;

class RandomScene {
  public:
    explicit RandomScene(unsigned seed) : random_(seed) {}

    std::string bytes() {
        VoxWriter writer;
        const int models = number(1, 4);
        for (int m = 0; m < models; ++m) addModel(writer);
        // Nodes refer to greater ids only, so there is no cycle; several parents are common.
        const int nodes = number(3, 14);
        for (int id = 0; id < nodes - 1; ++id) addInnerNode(writer, id, nodes);
        VoxWriter::Shape last;
        last.id = nodes - 1;
        writer.shape(last);
        writer.layer(0, {{"_hidden", number(0, 3) == 0 ? "1" : "0"}}).layer(1, {});
        for (int slot = 1; slot < 9; ++slot)
            writer.material(slot, {{"_type", number(0, 1) == 0 ? "_metal" : "_glass"}});
        return writer.finish();
    }

  private:
    int number(int least, int most) { return std::uniform_int_distribution(least, most)(random_); }

    void addModel(VoxWriter& writer) {
        const std::array<std::int32_t, 3> size{number(1, 20), number(1, 20), number(1, 20)};
        std::vector<VoxVoxel> voxels;
        for (int n = number(0, 60); n > 0; --n) {
            const auto coordinate = [&](std::size_t axis) {
                return static_cast<std::uint8_t>(number(0, size[axis]));
            };
            voxels.push_back(
                {coordinate(0), coordinate(1), coordinate(2), static_cast<std::uint8_t>(number(0, 12))});
        }
        writer.model(size, voxels);
    }

    void addInnerNode(VoxWriter& writer, int id, int nodes) {
        const auto child = [&] { return number(id + 1, std::min(id + 4, nodes - 1)); };
        if (id > 0 && number(0, 1) == 0) {
            writer.group(id, {child(), child()}, {{"_hidden", number(0, 9) == 0 ? "1" : "0"}});
            return;
        }
        static constexpr std::array kBytes{4, 20, 36, 17, 105, 97, 1, 81, 120, 50, 2, 9, 118, 68};
        VoxWriter::Transform transform;
        transform.id = id;
        transform.child = child();
        transform.layer = number(-1, 2);
        test::VoxDict frame;
        if (number(0, 3) != 0) {
            const std::size_t choice =
                static_cast<std::size_t>(number(0, static_cast<int>(kBytes.size()) - 1));
            frame.emplace_back("_r", std::to_string(kBytes[choice]));
        }
        if (number(0, 3) != 0) {
            std::string t = std::to_string(number(-50, 50));
            for (int axis = 1; axis < 3; ++axis) t += " " + std::to_string(number(-50, 50));
            frame.emplace_back("_t", t);
        }
        transform.frames = {frame};
        writer.transform(transform);
    }

    std::mt19937 random_;
};

TEST(VoxPlacementProperty, AgreesWithTheIndependentReader) {
    int withInstances = 0;
    for (unsigned seed = 0; seed < kScenes; ++seed) {
        const std::string bytes = RandomScene(seed).bytes();
        const auto expected = test::IndependentVoxReader(bytes).instances();
        test::ImportRun run;
        const auto asset = run(bytes);
        if (expected.empty()) {
            ASSERT_FALSE(asset) << seed;
            EXPECT_EQ(asset.error().code, ErrorCode::NothingToConvert);
            continue;
        }
        ++withInstances;
        ASSERT_TRUE(asset) << seed << ": " << describe(asset.error());
        ASSERT_EQ(asset->instances.size(), expected.size()) << seed;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_TRUE(test::worldCellsOf(*asset, asset->instances[i]) == test::worldCellsOf(expected[i]))
                << seed;
        }
    }
    EXPECT_GT(withInstances, kScenes / 2);
}

TEST(VoxPlacementProperty, MergedAndSeparateInstancesShowTheSame) {
    for (unsigned seed = 0; seed < kScenes; ++seed) {
        const std::string bytes = RandomScene(seed).bytes();
        test::ImportRun run;
        const auto separate = run(bytes);
        if (!separate) continue;
        run.settings.merge = true;
        const auto merged = run(bytes);
        ASSERT_TRUE(merged) << seed;
        std::map<test::Cell, test::VoxelLook> world;
        for (const Instance& instance : separate->instances) {
            for (const auto& [cell, look] : test::worldCellsOf(*separate, instance)) world[cell] = look;
        }
        const std::vector<std::pair<test::Cell, test::VoxelLook>> expected(world.begin(), world.end());
        EXPECT_TRUE(test::worldCellsOf(*merged, merged->instances[0]) == expected) << seed;
    }
}

TEST(VoxPlacementProperty, ThreadsChangeNothing) {
    const auto outcome = [](const std::string& bytes, std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        test::ImportRun run;
        const auto asset = run(bytes);
        std::string text = asset ? "" : describe(asset.error());
        for (const Diagnostic& d : run.diagnostics.entries()) text += d.id + ": " + d.message + "\n";
        std::vector<std::vector<std::pair<test::Cell, test::VoxelLook>>> cells;
        if (asset) {
            for (const Instance& instance : asset->instances)
                cells.push_back(test::worldCellsOf(*asset, instance));
        }
        return std::make_pair(text, cells);
    };
    for (unsigned seed = 0; seed < 30; ++seed) {
        const std::string bytes = RandomScene(seed).bytes();
        EXPECT_TRUE(outcome(bytes, 1) == outcome(bytes, 8)) << seed;
    }
}

}  // namespace
}  // namespace pfvox
