// Which file is shown, and when it has changed.
#include <gmock/gmock.h>

#include "file_watch.hpp"
#include "open_path.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {
namespace {

using namespace viewer;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(FileWatch, ReportsAChangeOnceAndOnlyAtRest) {
    const TempFolder folder;
    writeText(folder / "a", "one");
    FileWatch watch;
    watch.watch({folder / "a"});
    EXPECT_FALSE(watch.poll());
    writeText(folder / "a", "longer");
    EXPECT_FALSE(watch.poll()) << "it may still be being written";
    writeText(folder / "a", "longer still");
    EXPECT_FALSE(watch.poll());
    EXPECT_TRUE(watch.poll());
    EXPECT_FALSE(watch.poll());
}

TEST(FileWatch, SeesFilesThatAppearGoAndAreReplaced) {
    const TempFolder folder;
    writeText(folder / "a", "one");
    FileWatch watch;
    watch.watch({folder / "a", folder / "later"});
    writeText(folder / "later", "two");
    EXPECT_FALSE(watch.poll());
    EXPECT_TRUE(watch.poll());
    writeText(folder / "new", "other");
    std::filesystem::rename(folder / "new", folder / "a");
    EXPECT_FALSE(watch.poll());
    EXPECT_TRUE(watch.poll());
    std::filesystem::remove(folder / "later");
    EXPECT_FALSE(watch.poll());
    EXPECT_TRUE(watch.poll());
    watch.watch({});
    EXPECT_FALSE(watch.poll());
}

TEST(OpenPath, FolderGivesItsScenesFirst) {
    const TempFolder folder;
    writeText(folder / "b.pf_vox", "");
    writeText(folder / "a.pf_vox", "");
    writeText(folder / "z.toml", "[[models]]\npath = 'a.pf_vox'\n");
    writeText(folder / "settings.toml", "quality = 3\n");
    writeText(folder / "hall.vox", "");
    const Result<OpenPath> open = openPath(folder / "");
    ASSERT_TRUE(open) << describe(open.error());
    EXPECT_EQ(open->file.filename(), "z.toml");
    std::vector<std::string> names;
    for (const auto& file : open->siblings) names.push_back(file.filename().string());
    EXPECT_THAT(names, ElementsAre("z.toml", "a.pf_vox", "b.pf_vox"));
    EXPECT_EQ(neighborOf(*open, 1).filename(), "a.pf_vox");
    EXPECT_EQ(neighborOf(*open, -1).filename(), "b.pf_vox");
    EXPECT_EQ(neighborOf(*open, 3).filename(), "z.toml");
}

TEST(OpenPath, ABrokenSceneIsStillTheScene) {
    const TempFolder folder;
    writeText(folder / "a.pf_vox", "");
    writeText(folder / "scene.toml", "[[models\n");
    EXPECT_EQ(openPath(folder / "").value().file.filename(), "scene.toml");
}

TEST(OpenPath, ErrorsSayWhatToDo) {
    const TempFolder folder;
    const Result<OpenPath> none = openPath(folder / "none");
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::FileNotFound);
    std::filesystem::create_directory(folder / "empty");
    const Result<OpenPath> empty = openPath(folder / "empty");
    ASSERT_FALSE(empty);
    EXPECT_THAT(empty.error().message, HasSubstr("vox2pf"));
}

TEST(OpenPath, FilesOfASceneAreItselfAndItsModels) {
    Scene scene;
    scene.models = {{.path = "a.pf_vox"}, {.path = "../b.pf_vox"}};
    EXPECT_THAT(filesOf("/x/y/s.toml", scene), ElementsAre("/x/y/s.toml", "/x/y/a.pf_vox", "/x/b.pf_vox"));
}

}  // namespace
}  // namespace pfvox::test
