// Reference store: path-traced pictures kept in a folder, so that several fields of one scene are held
// against the same ones and no path is traced twice. A text line says what a picture shows; one that says
// anything else is left aside.
#pragma once

#include <filesystem>
#include <pfvox/verify.hpp>

#include "probe-bake/verify_report.hpp"

namespace pfvox::tools {

class ReferenceStore {
  public:
    /// `scene`: hash of the scene as its probes were baked. Without a folder nothing is kept.
    ReferenceStore(std::filesystem::path folder, const ContentKey& scene);

    /// The picture that was kept last, with as many paths as it has; an empty one (`samples` 0) without any
    /// that fits.
    ReferencePicture find(const NamedCamera& named, const VerifySettings& settings) const;

    /// Instead of what was kept before. Errors: FileNotWritable.
    Result<void> keep(const NamedCamera& named, const VerifySettings& settings,
                      const ReferencePicture& picture) const;

  private:
    std::filesystem::path fileOf(const NamedCamera& named, const VerifySettings& settings) const;

    std::filesystem::path folder_;
    std::string scene_;
};

}  // namespace pfvox::tools
