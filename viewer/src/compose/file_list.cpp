#include "compose/file_list.hpp"

#include <algorithm>
#include <system_error>

namespace pfvox::viewer {

namespace fs = std::filesystem;

Result<FileList> listFiles(const fs::path& folder, std::span<const std::string_view> extensions) {
    std::error_code error;
    FileList list{.folder = fs::absolute(folder.empty() ? fs::path(".") : folder, error).lexically_normal(),
                  .folders = {},
                  .files = {}};
    if (!list.folder.has_filename()) list.folder = list.folder.parent_path();  // "/a/b/"
    for (fs::directory_iterator at(list.folder, error), end; !error && at != end; at.increment(error)) {
        std::string name = at->path().filename().string();
        std::error_code ignored;
        if (name.starts_with('.')) continue;
        if (at->is_directory(ignored)) {
            list.folders.push_back(std::move(name));
        } else if (std::ranges::find(extensions, at->path().extension().string()) != extensions.end()) {
            list.files.push_back(std::move(name));
        }
    }
    if (error) {
        return tl::make_unexpected(
            Error{.code = ErrorCode::FileNotReadable, .message = error.message(), .file = list.folder});
    }
    std::ranges::sort(list.folders);
    std::ranges::sort(list.files);
    return list;
}

}  // namespace pfvox::viewer
