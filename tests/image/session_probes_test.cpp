// Whose probes light what is shown, the atlas in the window, and what happens to files that nobody waits for.
#include <gmock/gmock.h>

#include <condition_variable>
#include <mutex>

#include "support/lit_hall.hpp"
#include "support/session_fixture.hpp"

namespace pfvox::test {
namespace {

using namespace viewer;
using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

const fs::path kHallProbes = fs::path(PFVOX_TESTS_DIR) / "image/golden/hall.pf_probe";

class SessionProbesTest : public SessionFixture {
  protected:
    void SetUp() override {
        SessionFixture::SetUp();
        writeLitHall(folder.path());  // hall.toml and hall.pf_vox
    }
    std::string allMessages() const {
        std::string all;
        for (const Message& message : log.messages()) all += message.text + "\n";
        return all;
    }
};

TEST_F(SessionProbesTest, TheNextFileHasItsOwn) {
    start({.path = folder.path(), .probes = {.file = kHallProbes}});
    ASSERT_EQ(session->document.shown()->path.file.filename(), "hall.toml");
    ASSERT_NE(session->document.probes(), nullptr);
    press(kKeyPageDown);
    settle();
    ASSERT_EQ(session->document.shown()->path.file.filename(), "hall.pf_vox");
    EXPECT_EQ(session->document.probes(), nullptr) << "those of the scene before are not its own";
    session->document.dropProbes();
    fs::copy_file(kHallProbes, folder / "hall.pf_probe");
    press(kKeyPageUp);
    settle();
    EXPECT_NE(session->document.probes(), nullptr) << "dropped were those of another file";
}

TEST_F(SessionProbesTest, ANewSceneHasNone) {
    start({.path = folder / "hall.toml", .probes = {.file = kHallProbes}});
    ASSERT_NE(session->document.probes(), nullptr);
    press('N', true);
    session->document.addModels({folder / "hall.pf_vox"});
    settle();
    ASSERT_EQ(scene().models.size(), 1u);
    write("hall.pf_vox", box(8));  // read again, with the probes of what is shown
    settle();
    EXPECT_EQ(voxels(), 512u);
    EXPECT_EQ(session->document.probes(), nullptr);
    press('9');
    EXPECT_THAT(log.strip().value_or(""), HasSubstr("save the scene"));
    EXPECT_THAT(allMessages(), Not(HasSubstr("no .pf_probe")));
}

TEST_F(SessionProbesTest, ASceneThatIsSavedBesideProbesTakesThem) {
    fs::copy_file(folder / "hall.toml", folder / "other.toml");
    fs::copy_file(kHallProbes, folder / "hall.pf_probe");
    start(folder / "other.toml");
    EXPECT_EQ(session->document.probes(), nullptr);
    ASSERT_TRUE(session->document.composer.saveAs(folder / "hall.toml"));
    settle();
    ASSERT_NE(session->document.probes(), nullptr);
    EXPECT_TRUE(session->document.probes()->ofThisScene);
}

TEST_F(SessionProbesTest, WithoutAnotherFileThereIsNoNextOne) {
    start(folder / "hall.toml");
    press('N');
    press(kKeyRight);
    press(kKeyPageDown);
    settle();
    EXPECT_FALSE(session->document.composer.isAsking()) << "about changes that nothing endangers";
    EXPECT_TRUE(session->document.composer.editor.canUndo());
    EXPECT_THAT(log.messages().back().text, HasSubstr("no other file"));
    start();
    press(kKeyPageDown);
    settle();
    EXPECT_FALSE(log.strip());
    press('V');
    EXPECT_THAT(log.messages().back().text, HasSubstr("nothing is open"));
}

TEST_F(SessionProbesTest, AClickOnAMapSelectsItsProbe) {
    fs::copy_file(kHallProbes, folder / "hall.pf_probe");
    start({.path = folder / "hall.toml", .mode = ViewMode::AtlasDepth});
    press('N');  // a model that would have handles
    drawn();
    const std::optional<AtlasLayout> maps = session->view.shownAtlas();
    ASSERT_TRUE(maps);
    EXPECT_EQ(maps->cell, 32u);
    EXPECT_EQ(maps->columns, 5u);
    EXPECT_EQ(maps->count, 15u);
    EXPECT_EQ(maps->pages, 2u);
    EXPECT_EQ(maps->cornerOf(7), glm::uvec2(64, 32));
    const auto click = [&](double x, double y) {
        session->input.clickAt(glm::dvec2(x, y) / glm::dvec2(kSize));
    };
    click(70.0, 40.0);
    EXPECT_EQ(session->view.selectedProbe, 7u);
    EXPECT_FALSE(session->view.pick()) << "there is no scene under the cursor";
    EXPECT_FALSE(session->view.gizmo());
    session->view.atlas.page = 1;
    drawn();
    click(1.0, 1.0);
    EXPECT_EQ(session->view.selectedProbe, 15u);
    click(158.0, 90.0);
    EXPECT_EQ(session->view.selectedProbe, 15u) << "no map there";
    EXPECT_FALSE(session->view.shownAtlas()->cornerOf(7)) << "on the other page";
    session->view.atlas.probe = 3;
    drawn();
    EXPECT_EQ(session->view.shownAtlas()->pages, 1u);
    click(80.0, 60.0);
    EXPECT_EQ(session->view.selectedProbe, 3u);
    press('2');
    drawn();
    EXPECT_FALSE(session->view.shownAtlas());
    EXPECT_TRUE(session->view.gizmo());
}

/// Files whose name begins with "slow" are read when they are let go.
class SlowReader {
  public:
    Result<LoadedScene> operator()(const fs::path& file, const Limits& limits, Diagnostics& diagnostics) {
        if (file.filename().string().starts_with("slow")) {
            std::unique_lock lock(mutex_);
            // Ends by itself if nobody lets go: a session that waits is slow, not stuck.
            released_.wait_for(lock, std::chrono::seconds(10), [&] { return isReleased_; });
        }
        return loadScene(file, limits, diagnostics);
    }
    void release() {
        const std::scoped_lock lock(mutex_);
        isReleased_ = true;
        released_.notify_all();
    }

  private:
    std::mutex mutex_;
    std::condition_variable released_;
    bool isReleased_ = false;
};

TEST_F(SessionProbesTest, AnotherFileIsOpenedWithoutWaitingForTheOneBefore) {
    write("slow.pf_vox", box(4));
    write("quick.pf_vox", box(8));
    SlowReader reader;
    start({.path = folder / "quick.pf_vox", .read = std::ref(reader)});
    session->document.open(folder / "slow.pf_vox");
    const auto begun = std::chrono::steady_clock::now();
    session->document.open(folder / "quick.pf_vox");
    settle();
    EXPECT_EQ(voxels(), 512u);
    session->document.open(folder / "slow.pf_vox");
    press('N', true);
    EXPECT_TRUE(session->document.shown()->path.file.empty()) << "a new scene";
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(8));
    reader.release();
    settle();
    EXPECT_TRUE(session->document.shown()->path.file.empty()) << "what comes too late is not shown";
    endBackground();  // before its reader
}

}  // namespace
}  // namespace pfvox::test
