// pfview: shows PF_VOX files.
#include <cstdio>
#include <pfvox/error.hpp>

#include "common/finish_output.hpp"
#include "headless.hpp"
#include "options.hpp"
#include "report.hpp"
#ifdef PFVOX_WITH_WINDOW
#include "window/app.hpp"
#endif

namespace {

using namespace pfvox;
using namespace pfvox::viewer;

class ConsoleDiagnostics final : public Diagnostics {
  public:
    explicit ConsoleDiagnostics(bool quiet) : quiet_(quiet) {}
    void report(Diagnostic diagnostic) override {
        if (quiet_) return;
        const char* const kind = diagnostic.severity == Severity::Note ? "note" : "warning";
        std::fprintf(stderr, "pfview: %s: %s [%s]\n", kind, diagnostic.message.c_str(),
                     diagnostic.id.c_str());
    }

  private:
    bool quiet_;
};

Result<void> printDevices() {
    PFVOX_TRY(const std::vector<gpu::DeviceInfo>, devices, gpu::listDevices());
    std::fputs(deviceTable(devices).c_str(), stdout);
    return {};
}

Result<void> run(const Options& options, Diagnostics& diagnostics) {
    if (options.listDevices) return printDevices();
    if (options.isHeadless()) return runHeadless(options, diagnostics);
#ifdef PFVOX_WITH_WINDOW
    return runWindow(options, diagnostics);
#else
    return fail(ErrorCode::UnsupportedFeature, "this pfview was built without windows; use --screenshot");
#endif
}

}  // namespace

int main(int argc, char** argv) {
    const auto parsed = parseOptions(argc, argv);
    if (const auto* early = std::get_if<EarlyExit>(&parsed)) {
        std::fputs(early->text.c_str(), early->exitCode == 0 ? stdout : stderr);
        return early->exitCode;
    }
    const Options& options = std::get<Options>(parsed);
    ConsoleDiagnostics diagnostics(options.quiet);
    const Result<void> done = run(options, diagnostics);
    if (done) return static_cast<int>(tools::finishOutput(tools::ExitCode::Ok));
    std::fprintf(stderr, "pfview: %s\n", describe(done.error()).c_str());
    return exitCodeOf(done.error().code);
}
