#include "file_watch.hpp"

#include <system_error>
#include <utility>

namespace pfvox::viewer {

FileWatch::State FileWatch::stateOf(const std::filesystem::path& file) {
    std::error_code error;
    State state;
    state.time = std::filesystem::last_write_time(file, error);
    if (error) return {};
    state.exists = true;
    state.sizeBytes = std::filesystem::file_size(file, error);
    if (error) state.sizeBytes = 0;  // a folder
    return state;
}

void FileWatch::watch(const std::vector<std::filesystem::path>& files) {
    known_.clear();
    for (const std::filesystem::path& file : files) known_[file] = stateOf(file);
    seen_ = known_;
}

bool FileWatch::poll() {
    std::map<std::filesystem::path, State> now;
    for (const auto& [file, state] : known_) now[file] = stateOf(file);
    const bool atRest = now == std::exchange(seen_, now);
    if (!atRest || now == known_) return false;
    known_ = std::move(now);
    return true;
}

}  // namespace pfvox::viewer
