#include "common/paths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <pfvox/text_encoding.hpp>
#include <set>

#include "common/text.hpp"

namespace pfvox::tools {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxNameBytes = 200;

fs::path withoutSlashAtEnd(const fs::path& path) {
    return path.has_filename() ? path : path.parent_path();
}

/// The entry of a folder that has this name but for case.
std::optional<fs::path> entryLike(const fs::path& folder, const std::string& name) {
    std::error_code error;
    auto entry = fs::directory_iterator(folder.empty() ? "." : folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
        if (lowerCase(entry->path().filename().string()) == lowerCase(name))
            return folder / entry->path().filename();
    }
    return std::nullopt;
}

/// Of a name from outside, with nothing that a file system or a shell could take amiss.
std::string safeFileName(std::string_view name) {
    std::string safe;
    while (!name.empty()) {
        const CodePoint next = firstCodePoint(name);
        const std::size_t bytes = std::max<std::size_t>(next.bytes, 1);
        const char32_t c = next.value;
        const bool isWord = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                            c == '-' || c == '_';
        const bool isForeign = c >= 0x80 && escaped(name.substr(0, bytes)) == name.substr(0, bytes);
        const std::string_view kept =
            next.bytes != 0 && (isWord || isForeign) ? name.substr(0, bytes) : std::string_view("_");
        if (safe.size() + kept.size() > kMaxNameBytes) break;
        safe += kept;
        name.remove_prefix(bytes);
    }
    return safe;
}

}  // namespace

fs::path placeOf(const fs::path& path) {
    std::error_code error;
    const fs::path absolute = fs::absolute(path, error);
    return withoutSlashAtEnd((error ? path : absolute).lexically_normal());
}

fs::path canonicalName(const fs::path& path) {
    std::error_code error;
    // Made absolute first: of a path that does not exist at all weakly_canonical leaves a relative one.
    const fs::path absolute = fs::absolute(path, error);
    fs::path name = fs::weakly_canonical(absolute, error);
    if (error) name = absolute.lexically_normal();
    return withoutSlashAtEnd(name);
}

bool hasExtension(const fs::path& path, std::string_view extension) {
    return lowerCase(path.extension().string()) == lowerCase(extension);
}

bool isPresent(const fs::path& path) {
    std::error_code error;
    return fs::exists(fs::symlink_status(path, error));
}

std::optional<fs::path> nearlyNamed(const fs::path& path) {
    if (isPresent(path)) return std::nullopt;
    std::string text = path.string();
    std::ranges::replace(text, '\\', '/');
    fs::path found;
    for (const fs::path& part : fs::path(text)) {
        if (part.empty() || isPresent(found / part)) {
            found /= part;
        } else if (auto entry = entryLike(found, part.string())) {
            found = *std::move(entry);
        } else {
            return std::nullopt;
        }
    }
    return found;
}

std::vector<std::string> safeFileNames(std::span<const std::string> names) {
    std::vector<std::string> safe;
    for (const std::string& name : names) safe.push_back(safeFileName(name));
    // On some systems names that differ only in case are one file.
    std::set<std::string> taken;
    std::vector<bool> isDone(names.size(), false);
    for (std::size_t i = 0; i < names.size(); ++i)
        isDone[i] = !safe[i].empty() && safe[i] == names[i] && taken.insert(lowerCase(safe[i])).second;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (isDone[i]) continue;
        const std::string base = safe[i].empty() ? "unnamed" : safe[i];
        safe[i] = base;
        for (std::size_t number = 2; !taken.insert(lowerCase(safe[i])).second; ++number)
            safe[i] = fmt::format("{}-{}", base, number);
    }
    return safe;
}

}  // namespace pfvox::tools
