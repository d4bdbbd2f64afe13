// Any bytes as a .vox file: the whole conversion must end in an output that decodes, or in an error.
#include <pfvox/convert.hpp>

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace pfvox;
    // Tight limits: a finding is a crash, not a slow input.
    const Limits limits{.maxMemoryBytes = 64 << 20, .maxModels = 64, .maxInstances = 4096, .maxRegions = 64};
    DiagnosticList diagnostics;
    ConvertReport report;
    const auto bytes = std::as_bytes(std::span(data, size));
    const auto converted = convertBytes(bytes, "fuzz.vox", {}, limits, diagnostics, report);
    if (!converted) return 0;
    if (!decodePfVox(*converted, Limits{}, diagnostics)) std::abort();
    return 0;
}
