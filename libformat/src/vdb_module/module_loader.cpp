#include "vdb_module/module_loader.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <sys/mman.h>
#include <pfvox_module_id.hpp>

#include <algorithm>
#include <pfvox/threads.hpp>
#include <string_view>
#include <system_error>

namespace pfvox {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFileName = "pfvox_vdb.so";

tl::unexpected<Error> unavailable(std::string message) {
    return fail(ErrorCode::UnsupportedFeature, "OpenVDB files cannot be used: " + std::move(message));
}

/// Why the module was not opened, by what dlerror says, which is empty only if nothing failed.
tl::unexpected<Error> loaderError() {
    const char* const said = ::dlerror();
    const std::string text = said != nullptr ? said : "unknown reason";
    const auto says = [&](std::string_view part) { return text.find(part) != std::string::npos; };
    if (says("annot allocate") || says("failed to map segment") || says("cannot map")) {
        return fail(
            ErrorCode::LimitExceeded,
            fmt::format(
                "not enough memory to open the OpenVDB module ({}): close other programs, or raise the limit "
                "(ulimit -v)",
                text));
    }
    if (says("No such file")) return unavailable(text + " (the OpenVDB library must be installed)");
    return unavailable(text);
}

/// Libraries that OpenVDB needs start threads when they are opened, and TBB does later; each of them ends the
/// program where that fails, as for want of memory.
Result<void> checkRoom() {
    constexpr int kThreadsOfLibraries = 4;
    constexpr std::size_t kBytesOfLibraries = 96u << 20;
    const auto ours = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    const int wanted = kThreadsOfLibraries + static_cast<int>(ours);
    if (startableThreads(wanted) < wanted) {
        return fail(ErrorCode::LimitExceeded,
                    fmt::format("OpenVDB needs {} threads, which cannot be started: raise the limit of "
                                "processes (ulimit -u) or of "
                                "memory (ulimit -v), or use fewer threads (-j)",
                                wanted));
    }
    void* const room =
        ::mmap(nullptr, kBytesOfLibraries, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED) {
        return fail(
            ErrorCode::LimitExceeded,
            "not enough memory to open OpenVDB: close other programs, or raise the limit (ulimit -v)");
    }
    ::munmap(room, kBytesOfLibraries);
    return {};
}

Result<const VdbModule*> open(const fs::path& file) {
    PFVOX_CHECK(checkRoom());
    // Now, not when a function is first called: a missing symbol would end the program there. The handle
    // stays open: OpenVDB registers itself with libraries that outlive it.
    void* const handle = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) return loaderError();
    const auto entry = reinterpret_cast<VdbModuleEntry>(::dlsym(handle, kVdbModuleEntry));
    if (entry == nullptr) return unavailable(fmt::format("{} is no module of pfvox", file.string()));
    const VdbModule* const module = entry();
    if (const std::string_view id = module->buildId; id != PFVOX_MODULE_ID) {
        return unavailable(
            fmt::format("the module {} is of another build ({}, this is {}): install both from one package",
                        file.string(), id, PFVOX_MODULE_ID));
    }
    return module;
}

}  // namespace

std::vector<fs::path> moduleFolders() {
    std::vector<fs::path> folders;
    std::error_code error;
    if (const fs::path program = fs::read_symlink("/proc/self/exe", error); !error) {
        const fs::path folder = program.parent_path();
        for (const char* relative : {PFVOX_MODULES_FROM_BIN, "../lib/pfvox", "."}) {
            fs::path candidate = (folder / relative).lexically_normal();
            if (std::ranges::find(folders, candidate) == folders.end())
                folders.push_back(std::move(candidate));
        }
    }
    folders.emplace_back(PFVOX_MODULES_INSTALLED);
    return folders;
}

Result<const VdbModule*> openVdbModule(std::span<const fs::path> folders) {
    std::string places;
    for (const fs::path& folder : folders) {
        const fs::path file = folder / kFileName;
        std::error_code ignored;
        if (fs::exists(file, ignored)) return open(file);
        places += fmt::format("{}{}", places.empty() ? "" : ", ", folder.string());
    }
    return unavailable(
        fmt::format("the module {} is in none of {}: install it with pfvox or put it beside the program",
                    kFileName, places));
}

Result<const VdbModule*> vdbModule() {
    static const Result<const VdbModule*> kModule = openVdbModule(moduleFolders());
    return kModule;
}

ReportTo reportTo(Diagnostics& diagnostics) {
    return {.sink = &diagnostics,
            .report = [](Diagnostics& sink, Diagnostic diagnostic) { sink.report(std::move(diagnostic)); }};
}

}  // namespace pfvox
