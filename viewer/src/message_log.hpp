// MessageLog: what the viewer has to say, for its log window and the strip above the picture.
#pragma once

#include <mutex>
#include <optional>
#include <pfvox/error.hpp>
#include <string>
#include <vector>

namespace pfvox::viewer {

enum class MessageKind : std::uint8_t { Note, Warning, Error };

struct Message {
    MessageKind kind = MessageKind::Note;
    std::string text;
};

/// May be written by several threads. Keeps the latest thousand.
class MessageLog final : public Diagnostics {
  public:
    void report(Diagnostic diagnostic) override;
    void add(MessageKind kind, std::string text);
    /// Also becomes the strip.
    void addError(std::string text);

    std::vector<Message> messages() const;
    /// The latest error that nobody has dismissed.
    std::optional<std::string> strip() const;
    void dismissStrip();

  private:
    mutable std::mutex mutex_;
    std::vector<Message> messages_;
    std::optional<std::string> strip_;
};

}  // namespace pfvox::viewer
