// Any bytes as a scene file: what is accepted must be written so that it reads back, and its paths replaced.
#include <cstdlib>
#include <pfvox/scene.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace pfvox;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    DiagnosticList diagnostics;
    const auto scene = parseScene(text, "fuzz.toml", {}, diagnostics);
    if (!scene) return 0;
    const auto again = parseScene(sceneText(*scene), "again.toml", {}, diagnostics);
    if (!again || *again != *scene) std::abort();
    const auto edited = withModelPaths(text, "fuzz.toml", {}, diagnostics,
                                       [](const ModelPathUse&) { return "elsewhere/x.pf_vox"; });
    if (!edited) std::abort();
    return 0;
}
