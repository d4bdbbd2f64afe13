// Reference store: path-traced pictures kept in a folder, so that several fields of one scene are held against the same
// ones and none is traced twice. A text line says what a picture shows; one that says anything else is traced anew.
#pragma once

#include <filesystem>
#include <functional>
#include <pfvox/verify.hpp>

namespace pfvox::tools {

class ReferenceStore {
  public:
    /// `scene`: hash of the scene as its probes were baked. Without a folder nothing is kept.
    ReferenceStore(std::filesystem::path folder, const ContentKey& scene);

    /// The picture from the folder, or what `trace` gives, which is then kept. Errors: those of `trace`, FileNotWritable.
    Result<ReferencePicture> fetch(const Camera& camera, const VerifySettings& settings,
                                   const std::function<Result<ReferencePicture>()>& trace) const;

  private:
    std::filesystem::path folder_;
    std::string scene_;
};

}  // namespace pfvox::tools
