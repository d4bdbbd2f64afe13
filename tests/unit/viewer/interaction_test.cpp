// Keys and mouse events, as a window would send them.
#include "interaction.hpp"
#include "picture.hpp"

#include <gmock/gmock.h>

#include <set>
#include <tuple>

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

TEST_F(InteractionTest, WhatIsGrabbedMovesInsteadOfTheCamera) {
    interaction.grabs = [](glm::dvec2 parts) { return parts.x < 0.5; };
    interaction.cursor({200, 150});
    interaction.button(MouseButton::Left, true);
    EXPECT_FALSE(interaction.takeDrag());
    interaction.cursor({240, 150});
    auto drag = interaction.takeDrag();
    ASSERT_TRUE(drag);
    EXPECT_NEAR(drag->to.x, 0.3, 1e-12);
    EXPECT_FALSE(drag->ended);
    interaction.button(MouseButton::Left, false);
    drag = interaction.takeDrag();
    ASSERT_TRUE(drag);
    EXPECT_TRUE(drag->ended);
    EXPECT_EQ(camera.camera().position, glm::dvec3(0, 0, 10));
    // Pressed and let go on the spot: nothing moves, and it is no click.
    interaction.cursor({200, 150});
    interaction.button(MouseButton::Left, true);
    interaction.cursor({202, 150});
    interaction.button(MouseButton::Left, false);
    drag = interaction.takeDrag();
    ASSERT_TRUE(drag);
    EXPECT_NEAR(drag->to.x, 0.25, 1e-12);
    EXPECT_FALSE(interaction.takeClick());
    // Elsewhere, and with other buttons, the camera moves.
    this->drag(MouseButton::Left, {600, 100}, {700, 100});
    this->drag(MouseButton::Right, {100, 100}, {200, 100});
    EXPECT_FALSE(interaction.takeDrag());
    EXPECT_NE(camera.camera().position, glm::dvec3(0, 0, 10));
    // A window that loses the focus lets go.
    interaction.cursor({200, 150});
    interaction.button(MouseButton::Left, true);
    interaction.release();
    EXPECT_TRUE(interaction.takeDrag()->ended);
}

TEST(KeyBindings, NoKeyHasTwoMeaningsAndNoneMovesToo) {
    std::set<std::tuple<Key, bool, bool>> seen;
    for (const KeyBinding& binding : keyBindings()) {
        EXPECT_TRUE(seen.insert({binding.key, binding.control, binding.shift}).second) << binding.keyText;
        EXPECT_FALSE(binding.keyText.empty());
        EXPECT_FALSE(binding.what.empty());
        const bool moves = std::string("WASDEQ").find(binding.keyText) != std::string::npos;
        EXPECT_FALSE(moves && !binding.control) << binding.keyText;
    }
    EXPECT_EQ(bindingOf('Q', false), nullptr);
    EXPECT_EQ(bindingOf('Z', true)->command, Command::Undo);
    EXPECT_EQ(bindingOf('Z', true, true)->command, Command::Redo);
    EXPECT_EQ(bindingOf('F', false, true)->command, Command::FrameSelected);
    EXPECT_EQ(bindingOf('3', false, true)->command, Command::ShowView) << "shift says nothing here";
    EXPECT_EQ(bindingOf(Command::SaveAs)->keyText, "Ctrl+Shift+S");
    EXPECT_EQ(bindingOf(Command::Turn, -15)->key, kKeyRight);
    EXPECT_EQ(bindingOf(Command::Turn, 7), nullptr);
    EXPECT_EQ(bindingOf(kKeyOther, false), nullptr);
    EXPECT_EQ(bindingOf('7', false)->argument, static_cast<int>(ViewMode::Lod));
}

}  // namespace
}  // namespace pfvox::test
