#include <fmt/format.h>

#include <map>
#include <pfvox/pf_vox.hpp>

#include "scene/scene_parser.hpp"

namespace pfvox {

namespace fs = std::filesystem;

namespace {

/// Says which file a diagnostic is about.
class FileDiagnostics final : public Diagnostics {
  public:
    FileDiagnostics(const fs::path& file, Diagnostics& next) : file_(file), next_(next) {}
    void report(Diagnostic diagnostic) override {
        diagnostic.message = fmt::format("{}: {}", file_.string(), diagnostic.message);
        next_.report(std::move(diagnostic));
    }

  private:
    const fs::path& file_;
    Diagnostics& next_;
};

/// In single quotes, as a shell reads it.
std::string shellWord(const fs::path& path) {
    std::string word = "'";
    for (const char c : path.string()) {
        if (c == '\'') {
            word += "'\\''";
        } else {
            word += c;
        }
    }
    return word + "'";
}

/// The command that makes a PF_VOX file of `file`.
std::string remedyFor(const fs::path& file) {
    if (file.extension() != ".pf_vox") {
        return fmt::format("convert the source first: vox2pf convert {} -o {}", shellWord(file),
                           shellWord(fs::path(file).replace_extension(".pf_vox")));
    }
    return fmt::format(
        "convert its source again: vox2pf convert <source> -o {0}; a .pf_vox file of the program's "
        "predecessor is a source, too: vox2pf convert {0} -o 'converted/'",
        shellWord(file));
}

/// Bytes were lost or changed on their way.
bool isDamage(ErrorCode code) {
    return code == ErrorCode::Truncated || code == ErrorCode::ChecksumMismatch ||
           code == ErrorCode::BadStructure;
}

Result<std::shared_ptr<const OctreeAsset>> loadAsset(const fs::path& file, const Limits& limits,
                                                     Diagnostics& diagnostics) {
    FileDiagnostics named(file, diagnostics);
    Result<OctreeAsset> asset = loadPfVox(file, limits, named);
    if (asset) return std::make_shared<const OctreeAsset>(*std::move(asset));
    Error error = std::move(asset).error();
    if (error.file.empty()) error.file = file;
    if (error.code == ErrorCode::BadMagic) {
        error.message = "not a PF_VOX file; " + remedyFor(file);
        error.context.clear();
        error.offsetBytes.reset();
    } else if (error.code == ErrorCode::UnsupportedVersion) {
        error.message += " with this version of vox2pf";
    } else if (isDamage(error.code)) {
        error.message += "; copy the file again, or convert its source again";
    }
    return tl::make_unexpected(std::move(error));
}

/// The assets of a scene by file, each loaded once.
class AssetShelf {
  public:
    AssetShelf(const Limits& limits, Diagnostics& diagnostics) : limits_(limits), diagnostics_(diagnostics) {}

    Result<std::shared_ptr<const OctreeAsset>> get(const fs::path& file) {
        std::error_code error;
        fs::path name = fs::weakly_canonical(file, error);
        if (error) name = file.lexically_normal();
        const auto known = assets_.find(name);
        if (known != assets_.end()) return known->second;
        PFVOX_TRY(std::shared_ptr<const OctreeAsset>, asset, loadAsset(file, limits_, diagnostics_));
        assets_.emplace(std::move(name), asset);
        return asset;
    }

  private:
    const Limits& limits_;
    Diagnostics& diagnostics_;
    std::map<fs::path, std::shared_ptr<const OctreeAsset>> assets_;
};

/// A file that is not there is the scene's fault, any other the file's own.
Error inScene(Error error, const fs::path& sceneFile, const std::string& place) {
    if (error.code != ErrorCode::FileNotFound) {
        error.message += fmt::format(" (named by {}, {})", sceneFile.string(), place);
        return error;
    }
    error.message = fmt::format("{}: {}; if it is still to be made: vox2pf convert <source> -o {}",
                                error.file.string(), error.message, shellWord(error.file));
    error.file = sceneFile;
    error.context = place;
    return error;
}

/// Bounds and probe grid, when all parts are there.
Result<void> finish(LoadedScene& loaded, const fs::path& file, Diagnostics& diagnostics) {
    for (const PlacedAsset& part : loaded.parts) {
        const WorldBounds bounds = boundsOf(*part.asset, part.worldFromAsset);
        if (bounds.empty()) continue;
        loaded.bounds.include(bounds.min);
        loaded.bounds.include(bounds.max);
    }
    FileDiagnostics named(file, diagnostics);
    auto grid = fitProbeGrid(loaded.scene.probes, loaded.bounds, named);
    if (!grid) {
        grid.error().file = file;
        return tl::make_unexpected(std::move(grid).error());
    }
    loaded.probes = *grid;
    return {};
}

Result<LoadedScene> loadSingle(const fs::path& file, const Limits& limits, Diagnostics& diagnostics) {
    PFVOX_TRY(auto, asset, loadAsset(file, limits, diagnostics));
    LoadedScene loaded;
    loaded.scene.cameras = asset->cameras;
    loaded.scene.models.push_back({.path = file.filename().string(), .name = file.stem().string()});
    loaded.parts.push_back({.asset = std::move(asset), .worldFromAsset = identityAffine(), .model = 0});
    PFVOX_CHECK(finish(loaded, file, diagnostics));
    return loaded;
}

}  // namespace

Result<LoadedScene> loadScene(const fs::path& file, const Limits& limits, Diagnostics& diagnostics) {
    if (file.extension() != ".toml") return loadSingle(file, limits, diagnostics);
    FileDiagnostics named(file, diagnostics);
    PFVOX_TRY(scene::ParsedScene, parsed, scene::readWithPlaces(file, limits, named));
    LoadedScene loaded{.scene = std::move(parsed.scene), .parts = {}, .bounds = {}, .probes = {}};
    AssetShelf shelf(limits, diagnostics);
    std::uint64_t instances = 0;
    for (std::size_t i = 0; i < loaded.scene.models.size(); ++i) {
        const SceneModel& model = loaded.scene.models[i];
        if (!model.visible) continue;
        auto asset = shelf.get((file.parent_path() / fs::path(model.path)).lexically_normal());
        if (!asset) {
            return tl::make_unexpected(inScene(std::move(asset).error(), file, parsed.paths[i].text()));
        }
        instances += (*asset)->instances.size();
        if (instances > limits.maxInstances) {
            return tl::make_unexpected(Error{
                .code = ErrorCode::LimitExceeded,
                .message = fmt::format("with this model the scene has more instances than maxInstances = {}",
                                       limits.maxInstances),
                .file = file,
                .context = parsed.paths[i].text()});
        }
        const Affine world = worldFromAsset(model, **asset);
        loaded.parts.push_back({.asset = *std::move(asset), .worldFromAsset = world, .model = i});
    }
    PFVOX_CHECK(finish(loaded, file, diagnostics));
    return loaded;
}

}  // namespace pfvox
