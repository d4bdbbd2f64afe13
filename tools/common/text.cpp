#include "common/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <pfvox/text_encoding.hpp>
#include <vector>

namespace pfvox::tools {

std::string formatBytes(std::uint64_t bytes) {
    static constexpr std::array<std::string_view, 5> kUnits{"KiB", "MiB", "GiB", "TiB", "PiB"};
    if (bytes < 1024) return fmt::format("{} B", bytes);
    double value = static_cast<double>(bytes) / 1024.0;
    std::size_t unit = 0;
    while (value >= 1023.95 && unit + 1 < kUnits.size()) {  // 1023.95 would print as 1024.0
        value /= 1024.0;
        ++unit;
    }
    return fmt::format("{:.1f} {}", value, kUnits[unit]);
}

std::string formatCount(std::uint64_t count) {
    std::string digits = std::to_string(count);
    for (std::size_t left = digits.size(); left > 3;) {
        left -= 3;
        digits.insert(left, 1, ',');
    }
    return digits;
}

std::string formatRoughly(double count) {
    if (count < 1e4) return fmt::format("{:.0f}", count);
    if (count < 1e6) return fmt::format("{:.1f} thousand", count / 1e3);
    if (count < 1e9) return fmt::format("{:.1f} million", count / 1e6);
    return fmt::format("{:.1f} billion", count / 1e9);
}

std::string plural(std::uint64_t count, std::string_view singular) {
    return fmt::format("{} {}{}", formatCount(count), singular, count == 1 ? "" : "s");
}

std::string formatDuration(double seconds) {
    if (seconds < 60.0) return fmt::format("{:.2f} s", seconds);
    const auto whole = static_cast<std::uint64_t>(std::llround(seconds));
    return fmt::format("{} min {:02} s", whole / 60, whole % 60);
}

std::size_t displayWidth(std::string_view utf8) {
    return static_cast<std::size_t>(
        std::ranges::count_if(utf8, [](char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }));
}

std::string lowerCase(std::string_view ascii) {
    std::string text(ascii);
    std::ranges::transform(text, text.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return text;
}

namespace {

/// Optimal string alignment distance.
std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replace = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, replace});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
        }
    }
    return cost[a.size()][b.size()];
}

/// A pattern as an automaton: which of its steps can come next after what was read of the path. The time is
/// that of pattern times path, whatever the stars.
class Glob {
  public:
    explicit Glob(std::string_view pattern) {
        while (!pattern.empty()) {
            std::size_t taken = 1;
            if (pattern.starts_with("**")) {
                // "**/" also stands for no folder at all.
                if (pattern.starts_with("**/")) steps_.push_back({Step::Kind::SkipFolders});
                steps_.push_back({Step::Kind::AnyPath});
                taken = 2;
            } else if (pattern.front() == '*') {
                steps_.push_back({Step::Kind::AnyName});
            } else {
                steps_.push_back(
                    {pattern.front() == '?' ? Step::Kind::AnyOne : Step::Kind::One, pattern.front()});
            }
            pattern.remove_prefix(taken);
        }
        reached_.resize(steps_.size() + 1, false);
        reached_[0] = true;
        passFreeSteps(reached_);
    }

    void read(char c) {
        std::vector<bool> next(reached_.size(), false);
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            if (!reached_[i]) continue;
            const Step& step = steps_[i];
            const bool isInName = c != '/';
            if (step.kind == Step::Kind::AnyPath || (step.kind == Step::Kind::AnyName && isInName))
                next[i] = true;
            if (step.kind == Step::Kind::AnyOne ? isInName
                                                : step.kind == Step::Kind::One && step.character == c)
                next[i + 1] = true;
        }
        passFreeSteps(next);
        reached_ = std::move(next);
    }

    bool isMatch() const { return reached_.back(); }

  private:
    struct Step {
        enum class Kind { One, AnyOne, AnyName, AnyPath, SkipFolders };
        Kind kind = Kind::One;
        char character = '\0';
    };

    /// Adds what steps that read nothing lead to.
    void passFreeSteps(std::vector<bool>& reached) const {
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            if (!reached[i] || steps_[i].kind == Step::Kind::One || steps_[i].kind == Step::Kind::AnyOne)
                continue;
            reached[i + 1] = true;
            if (steps_[i].kind == Step::Kind::SkipFolders) reached[i + 3] = true;  // over "**" and '/'
        }
    }

    std::vector<Step> steps_;
    std::vector<bool> reached_;
};

/// Whether a terminal may get this character as it is.
bool isHarmless(char32_t c) {
    const bool isControl = c < 0x20 || (c >= 0x7f && c < 0xa0);
    const bool turnsDirection = c == 0x061c || c == 0x200e || c == 0x200f || (c >= 0x202a && c <= 0x202e) ||
                                (c >= 0x2066 && c <= 0x2069);
    const bool endsLine = c == 0x2028 || c == 0x2029;
    return !isControl && !turnsDirection && !endsLine;
}

}  // namespace

std::optional<std::string> nearestWord(std::string_view word, std::span<const std::string> candidates) {
    const std::string typed = lowerCase(word);
    std::optional<std::string> nearest;
    std::size_t best = std::max<std::size_t>(2, word.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
        const std::string known = lowerCase(candidate);
        const bool isBeginning = typed.size() >= 4 && known.starts_with(typed);
        const std::size_t distance = isBeginning ? 1 : editDistance(typed, known);
        if (distance >= best || distance >= candidate.size()) continue;
        best = distance;
        nearest = candidate;
    }
    return nearest;
}

bool globMatches(std::string_view pattern, std::string_view path) {
    if (pattern.find('/') == std::string_view::npos) {
        const std::size_t slash = path.rfind('/');
        if (slash != std::string_view::npos) path.remove_prefix(slash + 1);
    }
    Glob glob(pattern);
    for (const char c : path) glob.read(c);
    return glob.isMatch();
}

std::string escaped(std::string_view text) {
    std::string shown;
    while (!text.empty()) {
        const CodePoint next = firstCodePoint(text);
        const std::size_t bytes = std::max<std::size_t>(next.bytes, 1);
        if (next.bytes != 0 && isHarmless(next.value)) {
            shown += text.substr(0, bytes);
        } else if (text.front() == '\n') {
            shown += "\\n";
        } else if (next.bytes > 1) {
            shown += fmt::format("\\u{{{:x}}}", static_cast<std::uint32_t>(next.value));
        } else {
            shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(text.front()));
        }
        text.remove_prefix(bytes);
    }
    return shown;
}

}  // namespace pfvox::tools
