// Importing bytes that a test made, and looking at what was reported.
#pragma once

#include <algorithm>
#include <pfvox/import.hpp>
#include <span>
#include <string>

namespace pfvox::test {

struct ImportRun {
    ImportSettings settings{};
    Limits limits{};
    DiagnosticList diagnostics{};

    Result<VoxelAsset> operator()(const std::string& bytes, const std::string& file = "test.vox") {
        return importBytes(std::as_bytes(std::span(bytes)), file, settings, limits, diagnostics);
    }
    bool reported(const std::string& id) const {
        return std::ranges::any_of(diagnostics.entries(), [&](const Diagnostic& d) { return d.id == id; });
    }
    std::string messageOf(const std::string& id) const {
        for (const Diagnostic& d : diagnostics.entries()) {
            if (d.id == id) return d.message;
        }
        return {};
    }
};

}  // namespace pfvox::test
