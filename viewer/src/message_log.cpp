#include "message_log.hpp"

namespace pfvox::viewer {

namespace {
constexpr std::size_t kKept = 1000;
}

void MessageLog::report(Diagnostic diagnostic) {
    const bool warning = diagnostic.severity == Severity::Warning;
    add(warning ? MessageKind::Warning : MessageKind::Note, diagnostic.message + " [" + diagnostic.id + "]");
}

void MessageLog::add(MessageKind kind, std::string text) {
    const std::scoped_lock lock(mutex_);
    if (messages_.size() == kKept) messages_.erase(messages_.begin());
    messages_.push_back({kind, std::move(text)});
}

void MessageLog::addError(std::string text) {
    add(MessageKind::Error, text);
    const std::scoped_lock lock(mutex_);
    strip_ = std::move(text);
}

std::vector<Message> MessageLog::messages() const {
    const std::scoped_lock lock(mutex_);
    return messages_;
}

std::optional<std::string> MessageLog::strip() const {
    const std::scoped_lock lock(mutex_);
    return strip_;
}

void MessageLog::dismissStrip() {
    const std::scoped_lock lock(mutex_);
    strip_.reset();
}

}  // namespace pfvox::viewer
