#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <pfvox/import.hpp>
#include <string>
#include <vector>

#include "guarded.hpp"
#include "import/asset_check.hpp"
#include "import/importer.hpp"
#include "import/merge.hpp"
#include "io/byte_cursor.hpp"
#include "io/files.hpp"

namespace pfvox {

namespace {

const std::vector<import::Importer>& importers() {
    // Formats with a magic number first; the legacy format has none and is recognised by its name and sizes.
    static const std::vector<import::Importer> all{
        import::voxImporter(),
        import::svxImporter(),
        import::vdbImporter(),
        import::legacyImporter(),
    };
    return all;
}

std::string lowerCaseExtension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
    return extension;
}

bool isAppleDouble(std::string_view text) {
    return text.starts_with(std::string_view("\0\x05\x16\x07", 4));
}

/// What a file is that no importer takes, in words for the user.
std::string nameForeignContent(std::span<const std::byte> bytes) {
    const std::string_view text = io::asText(bytes.first(std::min<std::size_t>(bytes.size(), 64)));
    if (text.empty()) return "the file is empty";
    if (text.starts_with("version https://git-lfs")) {
        return "this is a Git LFS pointer, not the file itself: run `git lfs pull`";
    }
    if (isAppleDouble(text))
        return "this is what macOS keeps beside a file, not the file itself: convert the one without \"._\"";
    if (text.starts_with("SQLite format 3"))
        return "this is an SQLite database (Cubiquity keeps its voxels so)";
    if (text.starts_with("PFVOX")) return "this is a PF_VOX file, already converted";
    if (text.starts_with("\x89PNG")) return "this is a PNG picture";
    const bool printable = std::ranges::all_of(
        text, [](char c) { return (c >= 32 && c < 127) || c == '\n' || c == '\r' || c == '\t'; });
    return printable ? "this is a text file, not a voxel source"
                     : "no known voxel source: the first bytes fit none";
}

/// The VOX importer merges by itself, in the frame of its world: here its asset has one instance already.
Result<VoxelAsset> importMerged(const import::Importer& importer, const import::SourceBytes& source,
                                const ImportSettings& settings, const Limits& limits,
                                Diagnostics& diagnostics) {
    PFVOX_TRY(VoxelAsset, asset, importer.import(source, settings, limits, diagnostics));
    if (settings.merge) PFVOX_CHECK(import::mergeAsset(asset, limits, diagnostics));
    import::checkAsset(asset, diagnostics);
    return asset;
}

}  // namespace

std::span<const SourceFormat> sourceFormats() {
    static const std::vector<SourceFormat> formats = [] {
        std::vector<SourceFormat> list;
        for (const import::Importer& importer : importers()) list.push_back(importer.format);
        return list;
    }();
    return formats;
}

bool looksLikeSource(const std::filesystem::path& file) {
    const std::string extension = lowerCaseExtension(file);
    // What macOS keeps beside a file on foreign file systems has its name behind these two characters.
    if (file.filename().native().starts_with("._")) return false;
    // Ours and the thesis's files share this name: folder mode must not take its own output for input. Legacy
    // files are converted when they are named one by one.
    if (extension == ".pf_vox") return false;
    return std::ranges::any_of(sourceFormats(),
                               [&](const SourceFormat& f) { return f.extension == extension; });
}

Result<VoxelAsset> importBytes(std::span<const std::byte> bytes, const std::filesystem::path& file,
                               const ImportSettings& settings, const Limits& limits,
                               Diagnostics& diagnostics) {
    const import::SourceBytes source{.bytes = bytes, .file = file};
    const auto withFile = [&](Result<VoxelAsset> result) {
        if (!result && result.error().file.empty()) result.error().file = file;
        return result;
    };
    for (const import::Importer& importer : importers()) {
        if (!importer.recognises(source)) continue;
        return withFile(
            guarded([&] { return importMerged(importer, source, settings, limits, diagnostics); }));
    }
    return withFile(fail(ErrorCode::UnsupportedFormat, nameForeignContent(bytes)));
}

Result<VoxelAsset> importFile(const std::filesystem::path& file, const ImportSettings& settings,
                              const Limits& limits, Diagnostics& diagnostics) {
    PFVOX_TRY(const io::FileBytes, contents, io::readFile(file, limits.maxFileBytes));
    return importBytes(contents.bytes(), file, settings, limits, diagnostics);
}

}  // namespace pfvox
