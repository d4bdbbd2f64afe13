#include "common/depfile.hpp"

#include <fmt/format.h>

#include <pfvox/files.hpp>
#include <string_view>

namespace pfvox::tools {

namespace {

// What cannot be told, escaped or not. make: ';' begins a recipe, '=' an assignment, '*', '?' and '[' stand
// for other names, and CMake loses ':', '|' and '\'. ninja ends a name at most of these; what it could be
// told, '#' and '$', CMake loses on the way to it.
constexpr std::string_view kUntellableToMake = ":;=|\\*?[";
constexpr std::string_view kUntellableToNinja = "\"#$&'*:;<>?\\^`|";

bool isControl(char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

/// The first character that the reader cannot be told; 0 = none.
char untellable(std::string_view name, DepfileReader reader, bool isTarget) {
    const bool isMake = reader == DepfileReader::Make;
    for (const char c : name) {
        const std::string_view refused = isMake ? kUntellableToMake : kUntellableToNinja;
        if (isControl(c) || refused.find(c) != refused.npos) return c;
        if (c == '%' && isMake && isTarget) return c;  // a pattern rule
    }
    // "lib(member)" is in an archive, "out&:" a group of targets.
    if (isMake && (name.ends_with(')') || name.ends_with('&'))) return name.back();
    return 0;
}

Result<std::string> escaped(const std::filesystem::path& path, DepfileReader reader, bool isTarget) {
    const std::string name = path.string();
    if (const char c = untellable(name, reader, isTarget)) {
        const auto character = isControl(c) ? fmt::format("the control character 0x{:02x}", c)
                                            : fmt::format("the character {}", c);
        return tl::make_unexpected(
            Error{.code = ErrorCode::BadValue,
                  .message = fmt::format("its path has {}, which a depfile for {} cannot tell: rename it, or "
                                         "run without --depfile",
                                         character, reader == DepfileReader::Make ? "make" : "ninja"),
                  .file = path});
    }
    std::string text;
    if (name.starts_with('~')) text = "./";  // no home folder
    for (const char c : name) {
        if (c == ' ' || c == '#') text += '\\';
        if (c == '$') text += '$';
        text += c;
    }
    return text;
}

}  // namespace

Result<std::string> depfileText(const std::vector<DepfileRule>& rules, DepfileReader reader) {
    std::string text;
    for (const DepfileRule& rule : rules) {
        PFVOX_TRY(const std::string, target, escaped(rule.target, reader, true));
        text += target + ':';
        for (const auto& prerequisite : rule.prerequisites) {
            PFVOX_TRY(const std::string, name, escaped(prerequisite, reader, false));
            text += ' ' + name;
        }
        text += '\n';
    }
    return text;
}

Result<void> writeDepfile(const std::filesystem::path& file, const std::vector<DepfileRule>& rules,
                          DepfileReader reader) {
    PFVOX_TRY(const std::string, text, depfileText(rules, reader));
    return io::writeFileAtomically(file, std::as_bytes(std::span(text)));
}

}  // namespace pfvox::tools
