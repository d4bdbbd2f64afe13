// Name: a text of a source that many things may have. Names that come from one file view one piece of memory,
// which stays as long as one of them does: a thousand instances of one name hold it once.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace pfvox {

/// A string_view that keeps what it views. Its bytes never change; copies are cheap and share them.
class Name : public std::string_view {
  public:
    Name() = default;
    /// A copy of the text.
    Name(std::string_view text) {
        if (!text.empty()) keep(std::make_shared<const std::string>(text));
    }
    Name(const std::string& text) : Name(std::string_view(text)) {}  ///< a copy of the text
    Name(const char* text) : Name(std::string_view(text)) {}         ///< a copy of the text
    Name(std::string&& text) {
        if (!text.empty()) keep(std::make_shared<const std::string>(std::move(text)));
    }  ///< takes the text over
    /// Views `text`, a part of what `owner` keeps.
    Name(std::shared_ptr<const void> owner, std::string_view text)
        : std::string_view(text), owner_(std::move(owner)) {}

    Name(const Name&) = default;
    Name& operator=(const Name&) = default;
    Name(Name&& other) noexcept { swap(other); }
    Name& operator=(Name&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Name() = default;

    void swap(Name& other) noexcept {
        std::string_view::swap(other);
        owner_.swap(other.owner_);
    }

    std::string_view view() const { return *this; }          ///< while the name lives
    std::string str() const { return std::string(view()); }  ///< a copy
    operator std::string() const { return str(); }           ///< a copy

  private:
    void keep(std::shared_ptr<const std::string> text) {
        static_cast<std::string_view&>(*this) = *text;
        owner_ = std::move(text);
    }

    std::shared_ptr<const void> owner_;
};

}  // namespace pfvox
