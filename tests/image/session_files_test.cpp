// Files that cannot be shown: each is told with what to do, the last good scene stays, and mending is enough.
#include <gmock/gmock.h>

#include "support/session_fixture.hpp"

namespace pfvox::test {
namespace {

using namespace viewer;
using ::testing::AllOf;
using ::testing::HasSubstr;

class SessionFilesTest : public SessionFixture {
  protected:
    void SetUp() override {
        SessionFixture::SetUp();
        write("good.pf_vox", box(8));
        write("other.pf_vox", box(4));
        bytes = readText(folder / "other.pf_vox");
        start(folder / "good.pf_vox");
    }
    std::string stripAfterOpening(const std::string& content) {
        writeText(folder / "bad.pf_vox", content);
        session->document.open(folder / "bad.pf_vox");
        settle();
        EXPECT_EQ(session->document.shown()->path.file, folder / "good.pf_vox")
            << "the last good scene stays";
        EXPECT_TRUE(session->view.draw(kSize));
        return log.strip().value_or("");
    }
    void expectMendable() {
        writeText(folder / "bad.pf_vox", bytes);
        settle();
        EXPECT_FALSE(log.strip());
        EXPECT_EQ(voxels(), 64u);
    }
    std::string bytes;
};

TEST_F(SessionFilesTest, Missing) {
    session->document.open(folder / "nowhere.pf_vox");
    settle();
    EXPECT_THAT(log.strip().value_or(""), HasSubstr("nowhere.pf_vox"));
    EXPECT_EQ(voxels(), 512u);
}

TEST_F(SessionFilesTest, Foreign) {
    EXPECT_THAT(
        stripAfterOpening("\x89PNG\r\n\x1a\n and so on, long enough to have a header of some kind ......."),
        AllOf(HasSubstr("bad.pf_vox"), HasSubstr("vox2pf convert")));
    expectMendable();
}

TEST_F(SessionFilesTest, OfAnotherVersion) {
    std::string other = bytes;
    other[8] = 9;  // layout::Header::versionMajor
    EXPECT_THAT(stripAfterOpening(other),
                AllOf(HasSubstr("9."), HasSubstr("convert the source again with this version")));
    expectMendable();
}

TEST_F(SessionFilesTest, Truncated) {
    for (const std::size_t size : {bytes.size() / 2, bytes.size() - 1, std::size_t{40}, std::size_t{0}}) {
        EXPECT_THAT(stripAfterOpening(bytes.substr(0, size)), HasSubstr("bad.pf_vox")) << size;
    }
    expectMendable();
}

TEST_F(SessionFilesTest, Damaged) {
    std::string other = bytes;
    other[other.size() / 2] = static_cast<char>(other[other.size() / 2] ^ 0x10);
    EXPECT_THAT(stripAfterOpening(other), HasSubstr("bad.pf_vox"));
    expectMendable();
}

// A file that grows while it is looked at counts only when it rests; whatever was read in between, the end is
// right.
TEST_F(SessionFilesTest, ChangingWhileItIsRead) {
    session->document.open(folder / "other.pf_vox");
    settle();
    ASSERT_EQ(voxels(), 64u);
    write("large.pf_vox", demoRoom());
    const std::string large = readText(folder / "large.pf_vox");
    std::thread writer([&] {
        for (int piece = 1; piece <= 20; ++piece) {
            writeText(folder / "other.pf_vox",
                      large.substr(0, large.size() * static_cast<std::size_t>(piece) / 20));
            std::this_thread::sleep_for(std::chrono::milliseconds(7));
        }
    });
    for (int i = 0; i < 60; ++i) {
        session->update(now += 0.26);
        ASSERT_NE(session->document.shown(), nullptr);
        ASSERT_TRUE(session->view.draw(kSize));
    }
    writer.join();
    settle();
    settle();
    EXPECT_GT(voxels(), 1000u);
    EXPECT_FALSE(log.strip());
}

TEST_F(SessionFilesTest, AModelOfASceneThatBreaksWhileOneEdits) {
    writeText(
        folder / "s.toml",
        "[[models]]\npath = 'good.pf_vox'\n[[models]]\npath = 'other.pf_vox'\ntranslateVec = [2, 0, 0]\n");
    session->document.open(folder / "s.toml");
    settle();
    press('N');
    press(kKeyRight);
    writeText(folder / "other.pf_vox", "broken");
    settle();
    EXPECT_THAT(log.strip().value_or(""), HasSubstr("other.pf_vox"));
    EXPECT_EQ(instances(), 2u);
    press(kKeyRight);
    EXPECT_NEAR(scene().models[0].translateMetres.x, 0.2, 1e-6) << "edits go on in the document";
    writeText(folder / "other.pf_vox", bytes);
    settle();
    EXPECT_NEAR(session->document.shown()->loaded.parts[0].worldFromAsset[3].x, 0.2, 1e-6)
        << "and show when it is mended";
}

TEST_F(SessionFilesTest, ABrokenSceneFile) {
    writeText(folder / "s.toml", "[[models]]\npath = 'good.pf_vox'\nscaleVec = [0, 1, 1]\n");
    session->document.open(folder / "s.toml");
    settle();
    EXPECT_THAT(log.strip().value_or(""), AllOf(HasSubstr("line 3"), HasSubstr("scaleVec")));
    EXPECT_EQ(session->document.shown()->path.file, folder / "good.pf_vox");
    EXPECT_TRUE(scene().models.size() == 1 && scene().models[0].path == "good.pf_vox")
        << "what is edited is what is shown";
}

}  // namespace
}  // namespace pfvox::test
