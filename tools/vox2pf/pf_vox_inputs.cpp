#include "vox2pf/pf_vox_inputs.hpp"

#include <pfvox/import.hpp>

#include "vox2pf/commands.hpp"

namespace pfvox::tools {

Error withRemedy(Error error) {
    if (error.code != ErrorCode::BadMagic) return error;
    if (error.file.extension() == kPfVoxExtension) {
        error.message += ". One of the thesis program? Those are converted: vox2pf " + error.file.string() +
                         " -o converted/";
    } else if (error.file.extension() == ".pf_probe") {
        error.message += ". Probe files are read by probe-bake: probe-bake info " + error.file.string();
    } else if (looksLikeSource(error.file)) {
        const std::filesystem::path output =
            std::filesystem::path(error.file).replace_extension(kPfVoxExtension);
        error.message += ". This is a source file; convert it first: vox2pf " + error.file.string() + " -o " +
                         output.string();
    }
    return error;
}

}  // namespace pfvox::tools
