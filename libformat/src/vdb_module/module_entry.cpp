// The module's side of VdbModule.
#include <pfvox_module_id.hpp>

#include "export/vdb_export.hpp"
#include "import/vdb/vdb_import.hpp"
#include "vdb_module/vdb_module.hpp"

namespace pfvox {

namespace {

class ForwardedDiagnostics final : public Diagnostics {
  public:
    explicit ForwardedDiagnostics(ReportTo target) : target_(target) {}
    void report(Diagnostic diagnostic) override { target_.report(*target_.sink, std::move(diagnostic)); }

  private:
    ReportTo target_;
};

Result<VoxelAsset> importVdb(const import::SourceBytes& source, const ImportSettings& settings,
                             const Limits& limits, ReportTo diagnostics) {
    ForwardedDiagnostics forwarded(diagnostics);
    return import::vdb::importVdb(source, settings, limits, forwarded);
}

Result<std::vector<std::byte>> exportAsset(const OctreeAsset& asset, const Limits& limits,
                                           ReportTo diagnostics) {
    ForwardedDiagnostics forwarded(diagnostics);
    return vdb_export::exportVdb(asset, limits, forwarded);
}

constexpr VdbModule kModule{.buildId = PFVOX_MODULE_ID, .import = importVdb, .exportAsset = exportAsset};

}  // namespace

}  // namespace pfvox

extern "C" __attribute__((visibility("default"))) const pfvox::VdbModule* pfvoxVdbModule() {
    return &pfvox::kModule;
}
