// Keys and mouse events, as a window would send them.
#include "interaction.hpp"
#include "picture.hpp"

#include <gmock/gmock.h>

#include <set>

namespace pfvox::test {
namespace {

using namespace viewer;

class InteractionTest : public ::testing::Test {
  protected:
    InteractionTest() {
        camera.set({.position = {0, 0, 10}, .target = {0, 0, 0}});
        interaction.setSize({800, 600});
    }
    void drag(MouseButton button, glm::dvec2 from, glm::dvec2 to) {
        interaction.cursor(from);
        interaction.button(button, true);
        interaction.cursor(0.5 * (from + to));
        interaction.cursor(to);
        interaction.button(button, false);
    }
    CameraController camera;
    Interaction interaction{camera};
};

TEST_F(InteractionTest, ClickIsReportedOnceAsPartsOfTheWindow) {
    interaction.cursor({200, 150});
    interaction.button(MouseButton::Left, true);
    interaction.cursor({201, 150});  // a hand is not still
    interaction.button(MouseButton::Left, false);
    const auto click = interaction.takeClick();
    ASSERT_TRUE(click);
    EXPECT_NEAR(click->x, 0.25, 0.01);
    EXPECT_NEAR(click->y, 0.25, 0.01);
    EXPECT_FALSE(interaction.takeClick());
    EXPECT_EQ(camera.camera().position, glm::dvec3(0, 0, 10));
}

TEST_F(InteractionTest, LeftDragTurnsAndIsNoClick) {
    drag(MouseButton::Left, {100, 100}, {300, 100});
    EXPECT_FALSE(interaction.takeClick());
    EXPECT_EQ(camera.camera().target, glm::dvec3(0, 0, 0));
    EXPECT_LT(camera.camera().position.x, 0.0);
}

TEST_F(InteractionTest, RightAndMiddleDragShift) {
    for (const MouseButton button : {MouseButton::Right, MouseButton::Middle}) {
        camera.set({.position = {0, 0, 10}, .target = {0, 0, 0}});
        drag(button, {100, 100}, {300, 100});
        EXPECT_LT(camera.camera().target.x, 0.0);
        EXPECT_FALSE(interaction.takeClick());
    }
}

TEST_F(InteractionTest, ASecondButtonDoesNotTakeTheDragOver) {
    interaction.cursor({100, 100});
    interaction.button(MouseButton::Left, true);
    interaction.button(MouseButton::Right, true);
    interaction.cursor({200, 100});
    EXPECT_EQ(camera.camera().target, glm::dvec3(0, 0, 0)) << "it still turns";
    interaction.button(MouseButton::Right, false);
    interaction.cursor({300, 100});
    EXPECT_LT(camera.camera().position.x, -5.0) << "and goes on";
}

TEST_F(InteractionTest, HeldKeysMoveUntilTheyAreReleased) {
    camera.speed = 1.0;
    interaction.key('W', true, false);
    interaction.key(kKeyShift, true, false);
    EXPECT_TRUE(interaction.isMoving());
    interaction.advance(1.0);
    EXPECT_NEAR(camera.camera().position.z, 5.0, 1e-9);
    interaction.key('W', false, false);
    EXPECT_FALSE(interaction.isMoving());
    interaction.advance(1.0);
    EXPECT_NEAR(camera.camera().position.z, 5.0, 1e-9);
}

TEST_F(InteractionTest, LosingTheFocusReleasesEverything) {
    interaction.key('D', true, false);
    interaction.button(MouseButton::Left, true);
    interaction.release();
    EXPECT_FALSE(interaction.isMoving());
    interaction.cursor({500, 500});
    EXPECT_EQ(camera.camera().position, glm::dvec3(0, 0, 10));
}

TEST_F(InteractionTest, CommandsComeInOrderAndOnce) {
    interaction.key('3', true, false);
    interaction.key('F', true, false);
    interaction.key('F', false, false);
    interaction.key('Q', true, true);
    std::vector<Command> commands;
    for (const KeyBinding& binding : interaction.takeCommands()) commands.push_back(binding.command);
    EXPECT_THAT(commands, ::testing::ElementsAre(Command::ShowView, Command::FrameAll, Command::Quit));
    EXPECT_TRUE(interaction.takeCommands().empty());
    EXPECT_FALSE(interaction.isMoving()) << "Ctrl+Q is not Q";
}

TEST(KeyBindings, NoKeyHasTwoMeaningsAndNoneMovesToo) {
    std::set<std::pair<Key, bool>> seen;
    for (const KeyBinding& binding : keyBindings()) {
        EXPECT_TRUE(seen.insert({binding.key, binding.control}).second) << binding.keyText;
        EXPECT_FALSE(binding.keyText.empty());
        EXPECT_FALSE(binding.what.empty());
        const bool moves = std::string("WASDEQ").find(binding.keyText) != std::string::npos;
        EXPECT_FALSE(moves && !binding.control) << binding.keyText;
    }
    EXPECT_EQ(bindingOf('Q', false), nullptr);
    EXPECT_EQ(bindingOf(kKeyOther, false), nullptr);
    EXPECT_EQ(bindingOf('7', false)->argument, static_cast<int>(ViewMode::Lod));
}

}  // namespace
}  // namespace pfvox::test
