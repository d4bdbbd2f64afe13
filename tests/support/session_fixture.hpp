// A viewer's session on the test device with files of its own: what the window would do, without one.
#pragma once

#include <chrono>
#include <pfvox/files.hpp>
#include <pfvox/pf_vox.hpp>
#include <thread>

#include "session.hpp"
#include "support/picture_fixture.hpp"
#include "support/procedural.hpp"
#include "support/temp_folder.hpp"

namespace pfvox::test {

class SessionFixture : public PictureTest {
  protected:
    static constexpr glm::uvec2 kSize{160, 120};

    void TearDown() override {
        session.reset();
        endBackground();
        PictureTest::TearDown();
    }
    static VoxelAsset box(int edge, std::uint8_t red = 220) {
        VoxelAsset asset;
        asset.materials = {material(red, 20, 20)};
        VoxelModel model;
        fillBox(model, {.min = {0, 0, 0}, .max = glm::ivec3(edge)},
                [](glm::ivec3) { return MaterialIndex{0}; });
        asset.models.push_back(std::move(model));
        asset.instances.push_back({.model = 0, .worldFromModel = Affine{0.1}, .name = "box"});
        asset.source.voxelSizeMetres = 0.1;
        return asset;
    }
    void write(const std::string& name, const VoxelAsset& asset) {
        const auto bytes = encodePfVox(build(asset), EncodeSettings{});
        ASSERT_TRUE(bytes) << describe(bytes.error());
        ASSERT_TRUE(io::writeFileAtomically(folder / name, *bytes));
    }
    void start(const std::filesystem::path& path = {}) { start(viewer::SessionStart{.path = path}); }
    void start(const viewer::SessionStart& what, viewer::Memory memory = {}) {
        auto made = viewer::Session::create(device(), what, std::move(memory), log);
        ASSERT_TRUE(made) << describe(made.error());
        session = *std::move(made);
        session->view.windowSize = glm::dvec2(kSize);
        settle();
    }
    /// Until no thread of any session reads: what the test owns may then go.
    static void endBackground() {
        for (int i = 0; i < 2000 && viewer::backgroundThreads() > 0; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    bool isBusy() const { return session->document.isLoading() || session->document.composer.isReading(); }
    /// Lets a second pass, as far as the session can tell, and waits for what it reads.
    void settle() {
        for (int i = 0; i < 4; ++i) session->update(now += 0.26);
        for (int i = 0; i < 2000 && isBusy(); ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            session->update(now);
        }
        session->update(now);
        ASSERT_FALSE(isBusy());
    }
    void press(viewer::Key key, bool control = false, bool shift = false) {
        const viewer::KeyBinding* const binding = viewer::bindingOf(key, control, shift);
        ASSERT_NE(binding, nullptr);
        session->input.execute(*binding);
        session->update(now);
    }
    viewer::Picture drawn() {
        const Result<void> done = session->view.draw(kSize);
        EXPECT_TRUE(done) << describe(done.error());
        return session->view.frames().picture(device()).value();
    }
    std::uint64_t voxels() const { return session->document.shown()->scene.statistics().voxels; }
    std::uint32_t instances() const { return session->document.shown()->scene.statistics().instances; }
    const Scene& scene() const { return session->document.composer.editor.scene(); }

    TempFolder folder;
    viewer::MessageLog log;
    std::unique_ptr<viewer::Session> session;
    double now = 0.0;
};

}  // namespace pfvox::test
