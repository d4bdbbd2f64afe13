// Paths: what a path means. Where texts become paths: io::pathFromText (pfvox/files.hpp).
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pfvox::tools {

/// The place that a path names: absolute, without "." and "..", links not followed. Two inputs are the same
/// when their places are: of two links to one file each is an input of its own.
std::filesystem::path placeOf(const std::filesystem::path& path);

/// The file or folder that is reached there: as placeOf, links followed. For the question whether writing to
/// one path changes what is read from another.
std::filesystem::path canonicalName(const std::filesystem::path& path);

/// ".vox" of "A.VOX", too: the case of ASCII letters does not matter.
bool hasExtension(const std::filesystem::path& path, std::string_view extension);

/// Whether something is there, a link that leads nowhere included.
bool isPresent(const std::filesystem::path& path);

/// What is there under nearly that name: other case, or `\` where `/` was meant. Nothing when `path` itself
/// is there, or nothing is alike.
std::optional<std::filesystem::path> nearlyNamed(const std::filesystem::path& path);

/// File names, without extension, for names from outside, one for each: letters, digits, '-', '_' and what is
/// not ASCII stay, the rest becomes '_'; what would then be equal, also but for case, gets a number behind
/// it. A name that needs no change keeps it. Not longer than 200 bytes. They depend on the whole set: ask for
/// all at once.
std::vector<std::string> safeFileNames(std::span<const std::string> names);

}  // namespace pfvox::tools
