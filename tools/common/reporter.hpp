// Reporter: the one voice of a tool. Results go to stdout, messages to stderr; color only where it is
// wanted.
//
// A message has a fixed shape that people and scripts can read:
//     error: hall.vox: chunk nTRN @0x1a3f: child node 77 does not exist [bad-reference]
//     warning: hall.vox: 12 voxels lie outside their model [vox-voxels-outside]
// All functions may be called from several threads; a message is never torn by another one or by the progress
// line.
#pragma once

#include <cstddef>
#include <mutex>
#include <pfvox/error.hpp>
#include <span>
#include <string>
#include <string_view>

namespace pfvox::tools {

enum class ColorMode { Auto, Always, Never };
enum class Verbosity { Quiet, Warnings, Normal, Verbose };

struct ReporterSettings {
    ColorMode color = ColorMode::Auto;  ///< Auto: on a terminal, unless NO_COLOR is set
    Verbosity verbosity = Verbosity::Normal;
    bool json = false;  ///< stdout carries JSON lines only
    bool warningsAsErrors = false;
};

class Reporter {
  public:
    explicit Reporter(const ReporterSettings& settings);

    const ReporterSettings& settings() const { return settings_; }

    /// Text for stdout as it is, from Normal on: a quiet tool answers by its exit code.
    void result(std::string_view text);
    /// One JSON value and a newline for stdout, quiet or not. Only when settings().json.
    void jsonLine(std::string_view json);

    void error(const Error& error);
    void error(std::string_view message);
    /// Warnings (unless quiet) and notes (when verbose) about one file.
    void diagnostics(const std::filesystem::path& file, std::span<const Diagnostic> entries);
    /// What the tool is doing, for people; from Normal on.
    void status(std::string_view message);

    /// Shows a line that the next message or progress line replaces. Does nothing where stderr is not a
    /// terminal.
    void progress(std::string_view line);
    void clearProgress();
    bool showsProgress() const;

    /// Text in the colors of stdout, for results that name files or states.
    enum class Style { Strong, Good, Bad, Dim };
    std::string styled(Style style, std::string_view text) const;

    /// The part of a diagnostic list that counts as warnings.
    static std::size_t warningCount(std::span<const Diagnostic> entries);

  private:
    void message(std::string_view label, const char* colorCode, std::string_view text);
    void clearProgressLocked();

    ReporterSettings settings_;
    bool colorOut_ = false;
    bool colorErr_ = false;
    bool errIsTerminal_ = false;
    std::mutex mutex_;
    bool progressShown_ = false;
};

}  // namespace pfvox::tools
