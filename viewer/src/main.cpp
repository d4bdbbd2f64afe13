// pfview: shows PF_VOX files.
#include <cstdio>
#include <cstdlib>
#include <pfvox/error.hpp>

#include "background.hpp"
#include "common/program.hpp"
#include "common/reporter.hpp"
#include "headless.hpp"
#include "options.hpp"
#include "report.hpp"
#ifdef PFVOX_WITH_WINDOW
#include "window/app.hpp"
#endif

namespace {

using namespace pfvox;
using namespace pfvox::viewer;

/// Shows warnings as they come, for a window that is open for long.
class ConsoleDiagnostics final : public Diagnostics {
  public:
    explicit ConsoleDiagnostics(tools::Reporter& reporter) : reporter_(reporter) {}
    void report(Diagnostic diagnostic) override { reporter_.diagnostics({}, {&diagnostic, 1}); }

  private:
    tools::Reporter& reporter_;
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

tools::ExitCode runWith(const Options& options) {
    tools::Reporter reporter(
        {.verbosity = options.quiet ? tools::Verbosity::Quiet : tools::Verbosity::Verbose});
    DiagnosticList collected;  // equal ones become one line
    ConsoleDiagnostics shown(reporter);
    const bool isShort = options.listDevices || options.isHeadless();
    const Result<void> done = run(options, isShort ? static_cast<Diagnostics&>(collected) : shown);
    reporter.diagnostics({}, collected.entries());
    if (done) return tools::ExitCode::Ok;
    reporter.error(done.error());
    return tools::exitCodeOf(done.error().code);
}

}  // namespace

int main(int argc, char** argv) {
    const int code = tools::runProgram([&] {
        const auto parsed = parseOptions(argc, argv);
        if (const auto* early = std::get_if<EarlyExit>(&parsed)) {
            std::fputs(early->text.c_str(), early->exitCode == 0 ? stdout : stderr);
            return static_cast<tools::ExitCode>(early->exitCode);
        }
        return runWith(std::get<Options>(parsed));
    });
    // Whatever is still being read was for a window that is closed: nothing waits for it, and nothing that it
    // uses is taken down under it.
    if (backgroundThreads() > 0) std::quick_exit(code);
    return code;
}
