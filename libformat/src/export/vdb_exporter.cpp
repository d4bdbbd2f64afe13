// exportVdb: through the module that knows OpenVDB.
#include <pfvox/export.hpp>

#include "vdb_module/module_loader.hpp"

namespace pfvox {

Result<std::vector<std::byte>> exportVdb(const OctreeAsset& asset, const Limits& limits,
                                         Diagnostics& diagnostics) {
    PFVOX_TRY(const VdbModule*, module, vdbModule());
    return module->exportAsset(asset, limits, reportTo(diagnostics));
}

}  // namespace pfvox
