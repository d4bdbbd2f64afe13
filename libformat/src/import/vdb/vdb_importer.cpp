// What the registry knows of OpenVDB: the magic number, and where the importer is.
#include "import/importer.hpp"
#include "import/vdb/vdb_header.hpp"
#include "io/byte_cursor.hpp"
#include "vdb_module/module_loader.hpp"

namespace pfvox::import {

namespace {

bool recognises(const SourceBytes& source) {
    return io::ByteCursor(source.bytes).read<std::int64_t>().value_or(0) == vdb::kMagic;
}

Result<VoxelAsset> importThroughModule(const SourceBytes& source, const ImportSettings& settings,
                                       const Limits& limits, Diagnostics& diagnostics) {
    PFVOX_TRY(const VdbModule*, module, vdbModule());
    return module->import(source, settings, limits, reportTo(diagnostics));
}

}  // namespace

Importer vdbImporter() {
    return {.format = {.id = "vdb", .title = "OpenVDB", .extension = ".vdb"},
            .recognises = recognises,
            .import = importThroughModule};
}

}  // namespace pfvox::import
