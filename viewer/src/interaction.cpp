#include "interaction.hpp"

#include <utility>

namespace pfvox::viewer {

namespace {
constexpr double kDragThreshold = 4.0;  // a hand that clicks is not quite still
}

void Interaction::key(Key key, bool pressed, bool control, bool shift) {
    if (!pressed) {
        keys_.erase(key);
        return;
    }
    if (!control) keys_.insert(key);
    if (const KeyBinding* binding = bindingOf(key, control, shift)) commands_.push_back(*binding);
}

void Interaction::cursor(glm::dvec2 position) {
    const glm::dvec2 moved = std::exchange(cursor_, position);
    if (!held_) return;
    glm::dvec2 by = position - moved;
    if (!dragging_) {
        if (glm::length(position - pressedAt_) < kDragThreshold) return;
        dragging_ = true;
        by = position - pressedAt_;
    }
    if (grabbed_) {
        drag_ = Drag{.to = cursor_ / size_, .ended = false};
        return;
    }
    const glm::dvec2 parts = by / size_.y;
    *held_ == MouseButton::Left ? camera_->turn(parts) : camera_->pan(parts);
}

void Interaction::button(MouseButton button, bool pressed) {
    if (pressed) {
        if (held_) return;
        held_ = button;
        pressedAt_ = cursor_;
        dragging_ = false;
        grabbed_ = button == MouseButton::Left && grabs(cursor_ / size_);
    } else if (held_ == button) {
        if (!grabbed_ && !dragging_ && button == MouseButton::Left) click_ = cursor_ / size_;
        letGo();
        held_.reset();
    }
}

void Interaction::letGo() {
    if (!std::exchange(grabbed_, false)) return;
    drag_ = Drag{.to = (dragging_ ? cursor_ : pressedAt_) / size_, .ended = true};
}

void Interaction::release() {
    keys_.clear();
    letGo();
    held_.reset();
}

glm::dvec3 Interaction::heldDirection() const {
    const auto axis = [&](Key positive, Key negative) {
        return static_cast<double>(keys_.contains(positive)) - static_cast<double>(keys_.contains(negative));
    };
    return {axis('D', 'A'), axis('E', 'Q'), axis('W', 'S')};
}

void Interaction::advance(double seconds) {
    camera_->move(heldDirection(), seconds, keys_.contains(kKeyShift));
}

std::vector<KeyBinding> Interaction::takeCommands() {
    return std::exchange(commands_, {});
}

std::optional<glm::dvec2> Interaction::takeClick() {
    return std::exchange(click_, std::nullopt);
}

std::optional<Drag> Interaction::takeDrag() {
    return std::exchange(drag_, std::nullopt);
}

}  // namespace pfvox::viewer
