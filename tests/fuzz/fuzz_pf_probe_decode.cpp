// Any bytes as a PF_PROBE file: once as they are, and once as the changes to make behind the repaired hashes
// of a small valid file.
#include <array>
#include <cstdlib>

#include "support/pf_probe_surgery.hpp"

namespace {

using namespace pfvox;

void decode(std::span<const std::byte> bytes) {
    const Limits limits{.maxMemoryBytes = 64 << 20};
    DiagnosticList diagnostics;
    static_cast<void>(validatePfProbe(bytes, limits));
    const auto field = decodePfProbe(bytes, limits, diagnostics);
    if (!field) return;
    // Whatever was accepted can be written again, but for light that is no number, which validate reports.
    const auto again = encodePfProbe(*field, {});
    if (!again) {
        if (again.error().code != ErrorCode::BadValue || validatePfProbe(bytes, limits).empty()) std::abort();
        return;
    }
    if (decodePfProbe(*again, limits, diagnostics).value() != *field) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    decode(std::as_bytes(std::span(data, size)));
    // With light on faces or without.
    static const std::array<test::OpenFile, 2> samples{test::openFile(test::probeSample()),
                                                       test::openFile(test::faceSample())};
    test::OpenFile open = samples[size % 2];
    for (std::size_t i = 0; i + 4 <= size && i < 400; i += 4) {
        test::OpenFile::Part& part = open.parts[data[i] % open.parts.size()];
        part.raw[(data[i + 1] | std::size_t{data[i + 2]} << 8) % part.raw.size()] = data[i + 3];
    }
    decode(test::closeProbeFile(std::move(open)));
    return 0;
}
