#include "io/temporary.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <mutex>
#include <pfvox/files.hpp>
#include <set>
#include <string_view>

namespace pfvox::io {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kPrefix = ".pfvox-";
constexpr std::string_view kSuffix = ".tmp";
constexpr std::size_t kDigits = 16;

/// The temporaries of this process that have names, and the folders where those of others were looked for.
struct Names {
    std::shared_mutex naming;
    std::mutex mutex;
    std::set<fs::path> temporaries;
    std::set<fs::path> searched;
};

Names& names() {
    // Never destroyed: threads may still write while the process exits.
    static auto* all = new Names;
    return *all;
}

fs::path randomName(const fs::path& folder) {
    std::uint64_t number = 0;
    if (::getentropy(&number, sizeof number) != 0) return {};
    return folder / fmt::format("{}{:016x}{}", kPrefix, number, kSuffix);
}

bool isTemporaryName(std::string_view name) {
    if (name.size() != kPrefix.size() + kDigits + kSuffix.size()) return false;
    const std::string_view digits = name.substr(kPrefix.size(), kDigits);
    return name.starts_with(kPrefix) && name.ends_with(kSuffix) &&
           digits.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

void remember(const fs::path& name) {
    const std::scoped_lock lock(names().mutex);
    names().temporaries.insert(name);
}

std::string procPath(const Descriptor& descriptor) {
    return fmt::format("/proc/self/fd/{}", descriptor.get());
}

/// Not valid where such files cannot be made, or could not be given names later.
Descriptor createUnnamed([[maybe_unused]] const fs::path& folder) {
#ifdef O_TMPFILE
    Descriptor fd(::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666));
    // The lock is there before the name: whoever looks for leftovers finds the writer alive.
    if (fd.valid() && ::flock(fd.get(), LOCK_EX | LOCK_NB) == 0 && ::access(procPath(fd).c_str(), F_OK) == 0)
        return fd;
#endif
    return Descriptor();
}

bool hasName(const Descriptor& fd) {
    struct stat info {};
    return ::fstat(fd.get(), &info) == 0 && info.st_nlink > 0;
}

/// Between creation and lock another process may take the file for a leftover: then the next name.
Temporary createNamed(const fs::path& folder) {
    constexpr int kAttempts = 100;
    const auto naming = enterNaming();
    for (int i = 0; i < kAttempts; ++i) {
        fs::path name = randomName(folder);
        if (name.empty()) return {};
        Descriptor fd(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
        if (!fd.valid() && errno == EEXIST) continue;
        if (!fd.valid()) return {};
        const bool isTaken = ::flock(fd.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
        if (isTaken || !hasName(fd)) continue;
        remember(name);
        return {.descriptor = std::move(fd), .name = std::move(name)};
    }
    errno = EEXIST;
    return {};
}

}  // namespace

std::shared_lock<std::shared_mutex> enterNaming() {
    return std::shared_lock(names().naming);
}

Temporary createTemporary(const fs::path& folder) {
    if (Descriptor fd = createUnnamed(folder); fd.valid()) return {.descriptor = std::move(fd), .name = {}};
    return createNamed(folder);
}

bool linkTo(const Descriptor& descriptor, const fs::path& name) {
    return ::linkat(AT_FDCWD, procPath(descriptor).c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

fs::path nameTemporary(const fs::path& folder, const Descriptor& descriptor) {
    fs::path name;
    do {
        name = randomName(folder);
        if (name.empty()) return {};
        if (linkTo(descriptor, name)) {
            remember(name);
            return name;
        }
    } while (errno == EEXIST);
    return {};
}

void removeTemporary(const fs::path& name) {
    ::unlink(name.c_str());
    forgetTemporary(name);
}

void forgetTemporary(const fs::path& name) {
    const std::scoped_lock lock(names().mutex);
    names().temporaries.erase(name);
}

void removeLeftovers(const fs::path& folder) {
    {
        const std::scoped_lock lock(names().mutex);
        if (!names().searched.insert(folder).second) return;
    }
    std::error_code error;
    for (auto entry = fs::directory_iterator(folder, error); !error && entry != fs::directory_iterator();
         entry.increment(error)) {
        if (!isTemporaryName(entry->path().filename().native())) continue;
        const Descriptor fd(::open(entry->path().c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
        if (fd.valid() && ::flock(fd.get(), LOCK_EX | LOCK_NB) == 0) ::unlink(entry->path().c_str());
    }
}

void abandonOutputs() {
    names().naming.lock();  // for ever
    const std::scoped_lock lock(names().mutex);
    for (const fs::path& name : names().temporaries) ::unlink(name.c_str());
}

}  // namespace pfvox::io
