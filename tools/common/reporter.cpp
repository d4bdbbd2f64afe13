#include "common/reporter.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <tuple>
#include <utility>

#include "common/text.hpp"

namespace pfvox::tools {

namespace {

constexpr const char* kReset = "\x1b[0m";
constexpr const char* kEraseLine = "\r\x1b[K";

bool wantsColor(ColorMode mode, bool isTerminal) {
    if (mode != ColorMode::Auto) return mode == ColorMode::Always;
    const char* noColor = std::getenv("NO_COLOR");
    const char* terminal = std::getenv("TERM");
    const bool dumb = terminal != nullptr && std::string_view(terminal) == "dumb";
    return isTerminal && !dumb && (noColor == nullptr || *noColor == '\0');
}

const char* codeOf(Reporter::Style style) {
    switch (style) {
        case Reporter::Style::Strong:
            return "\x1b[1m";
        case Reporter::Style::Good:
            return "\x1b[32m";
        case Reporter::Style::Bad:
            return "\x1b[1;31m";
        case Reporter::Style::Dim:
            return "\x1b[2m";
    }
    return "";
}

/// How many bytes at the front are a line end or a code of ours.
std::size_t ownCode(std::string_view text) {
    if (text.starts_with('\n')) return 1;
    for (const std::string_view code : {kReset, "\x1b[1m", "\x1b[32m", "\x1b[1;31m", "\x1b[2m"}) {
        if (text.starts_with(code)) return code.size();
    }
    return 0;
}

/// Lines as they are, but for control characters of names that somebody forgot to escape.
std::string withoutForeignCodes(std::string_view text) {
    std::string shown;
    while (!text.empty()) {
        std::size_t bytes = ownCode(text);
        if (bytes != 0) {
            shown += text.substr(0, bytes);
        } else {
            bytes = std::min(text.find_first_of("\n\x1b", 1), text.size());
            shown += escaped(text.substr(0, bytes));
        }
        text.remove_prefix(bytes);
    }
    return shown;
}

void write(std::FILE* stream, std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stream);
}

}  // namespace

Reporter::Reporter(const ReporterSettings& settings)
    : settings_(settings),
      colorOut_(wantsColor(settings.color, ::isatty(STDOUT_FILENO) != 0)),
      colorErr_(wantsColor(settings.color, ::isatty(STDERR_FILENO) != 0)),
      errIsTerminal_(::isatty(STDERR_FILENO) != 0) {}

void Reporter::result(std::string_view text) {
    if (settings_.verbosity < Verbosity::Normal || settings_.json) return;
    const std::scoped_lock lock(mutex_);
    clearProgressLocked();
    write(stdout, withoutForeignCodes(text));
    std::fflush(stdout);
}

void Reporter::jsonLine(std::string_view json) {
    const std::scoped_lock lock(mutex_);
    clearProgressLocked();
    write(stdout, json);
    write(stdout, "\n");
    std::fflush(stdout);
}

void Reporter::message(std::string_view label, const char* colorCode, std::string_view text) {
    const std::string line = colorErr_ ? fmt::format("{}{}:{} {}\n", colorCode, label, kReset, escaped(text))
                                       : fmt::format("{}: {}\n", label, escaped(text));
    const std::scoped_lock lock(mutex_);
    clearProgressLocked();
    write(stderr, line);
}

void Reporter::error(const Error& error) {
    message("error", "\x1b[1;31m", fmt::format("{} [{}]", describe(error), toString(error.code)));
}

void Reporter::error(std::string_view text) {
    message("error", "\x1b[1;31m", text);
}

void Reporter::diagnostics(const std::filesystem::path& file, std::span<const Diagnostic> entries) {
    // Equal ones are one line, with the place of the first. Few kinds are many entries.
    std::map<std::tuple<Severity, std::string_view, std::string_view>, std::size_t> counts;
    for (const Diagnostic& entry : entries) ++counts[{entry.severity, entry.id, entry.message}];
    for (const Diagnostic& entry : entries) {
        const bool isWarning = entry.severity == Severity::Warning;
        if (settings_.verbosity == Verbosity::Quiet && !settings_.warningsAsErrors) continue;
        if (!isWarning && settings_.verbosity != Verbosity::Verbose) continue;
        const std::size_t count = std::exchange(counts[{entry.severity, entry.id, entry.message}], 0);
        if (count == 0) continue;
        const std::string place =
            entry.offsetBytes ? fmt::format(" @0x{:x}", *entry.offsetBytes) : std::string();
        // Messages about a scene and its files name the file themselves.
        const bool namesFile = file.empty() || entry.message.starts_with(file.string() + ":");
        const std::string subject = namesFile ? std::string() : file.string() + place + ": ";
        const std::string times = count > 1 ? fmt::format(" ({} times)", formatCount(count)) : std::string();
        message(isWarning ? "warning" : "note", isWarning ? "\x1b[1;33m" : "\x1b[36m",
                fmt::format("{}{}{} [{}]", subject, entry.message, times, entry.id));
    }
}

void Reporter::status(std::string_view text) {
    if (settings_.verbosity < Verbosity::Normal) return;
    const std::scoped_lock lock(mutex_);
    clearProgressLocked();
    write(stderr, escaped(text));
    write(stderr, "\n");
}

void Reporter::progress(std::string_view line) {
    if (!showsProgress()) return;
    const std::scoped_lock lock(mutex_);
    write(stderr, kEraseLine);
    write(stderr, escaped(line));
    std::fflush(stderr);
    progressShown_ = true;
}

void Reporter::clearProgress() {
    const std::scoped_lock lock(mutex_);
    clearProgressLocked();
}

void Reporter::clearProgressLocked() {
    if (!progressShown_) return;
    write(stderr, kEraseLine);
    std::fflush(stderr);
    progressShown_ = false;
}

bool Reporter::showsProgress() const {
    return errIsTerminal_ && settings_.verbosity >= Verbosity::Normal;
}

std::string Reporter::styled(Style style, std::string_view text) const {
    const std::string shown = escaped(text);
    return colorOut_ ? fmt::format("{}{}{}", codeOf(style), shown, kReset) : shown;
}

std::size_t Reporter::warningCount(std::span<const Diagnostic> entries) {
    return static_cast<std::size_t>(
        std::ranges::count(entries, Severity::Warning, [](const Diagnostic& d) { return d.severity; }));
}

}  // namespace pfvox::tools
