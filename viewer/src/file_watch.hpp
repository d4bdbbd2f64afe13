// FileWatch: tells when files have changed and are at rest again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

namespace pfvox::viewer {

/// Looks at size and time of the files whenever poll() is called; a few calls a second are enough. Folders,
/// network drives and files that are replaced by renaming are all the same to it.
class FileWatch {
  public:
    /// Forgets what was watched before. Their present state is the one that changes are counted from.
    void watch(const std::vector<std::filesystem::path>& files);
    /// True once for each change, at the first call that finds all files as the call before did: a file that
    /// is still being written does not count yet.
    bool poll();

  private:
    struct State {
        bool exists = false;
        std::uintmax_t sizeBytes = 0;
        std::filesystem::file_time_type time = {};
        bool operator==(const State&) const = default;
    };
    static State stateOf(const std::filesystem::path& file);

    std::map<std::filesystem::path, State> known_;  ///< when last reported
    std::map<std::filesystem::path, State> seen_;   ///< by the last poll
};

}  // namespace pfvox::viewer
