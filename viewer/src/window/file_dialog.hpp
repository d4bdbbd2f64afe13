// FileDialog: a window that asks for a file: a path to type, and a list to choose from.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compose/file_list.hpp"

namespace pfvox::viewer {

class FileDialog {
  public:
    struct Request {
        const char* title = "";
        const char* button = "";
        std::vector<std::string_view> extensions;
        bool forWriting = false;
    };
    enum class State : std::uint8_t { Open, Chosen, Cancelled };

    /// Where it begins, and what the path field holds.
    void begin(const std::filesystem::path& folder, const std::string& name);
    /// To be called in every frame while it is open. With Chosen, chosen() is the file.
    State draw(const Request& request);
    const std::filesystem::path& chosen() const { return chosen_; }

  private:
    void list(const std::filesystem::path& folder, const Request& request);
    bool accept(const Request& request);
    bool drawList(const Request& request);

    std::filesystem::path folder_;
    std::string path_;
    FileList files_;
    std::string error_;
    std::filesystem::path chosen_;
    bool begun_ = false;
    bool wantsKeys_ = false;  ///< the path field is to have the keyboard from the next frame on
    bool listed_ = false;
};

}  // namespace pfvox::viewer
