#include "common/depfile.hpp"

#include <pfvox/files.hpp>

namespace pfvox::tools {

namespace {

std::string escaped(const std::filesystem::path& path) {
    std::string text;
    for (const char c : path.string()) {
        if (c == ' ' || c == '#') text += '\\';
        if (c == '$') text += '$';
        text += c;
    }
    return text;
}

}  // namespace

std::string depfileText(const std::vector<DepfileRule>& rules) {
    std::string text;
    for (const DepfileRule& rule : rules) {
        text += escaped(rule.target) + ':';
        for (const auto& prerequisite : rule.prerequisites) text += ' ' + escaped(prerequisite);
        text += '\n';
    }
    return text;
}

Result<void> writeDepfile(const std::filesystem::path& file, const std::vector<DepfileRule>& rules) {
    const std::string text = depfileText(rules);
    return io::writeFileAtomically(file, std::as_bytes(std::span(text)));
}

}  // namespace pfvox::tools
