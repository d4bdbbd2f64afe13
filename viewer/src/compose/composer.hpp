// Composer: what editing needs beside the document: models read in the background, the scene as it looks now,
// and the question before unsaved changes are lost. Knows no window and no device; the session that owns it
// draws.
#pragma once

#include <deque>
#include <functional>
#include <utility>

#include "background.hpp"
#include "compose/model_shelf.hpp"
#include "message_log.hpp"

namespace pfvox::viewer {

/// What the window is to ask for.
enum class Dialog : std::uint8_t { None, Open, AddModel, SaveAs, LoadProbes };

enum class Answer : std::uint8_t { Save, Discard, Cancel };

class Composer {
  public:
    explicit Composer(MessageLog& log) : log_(&log) {}

    SceneEditor editor;
    Dialog dialog = Dialog::None;

    /// What has been loaded from `file` becomes the document. A PF_VOX file makes one without a file of its
    /// own.
    void begin(const std::filesystem::path& file, const LoadedScene& loaded);
    /// An empty document without a file; paths count from `folder`.
    void beginEmpty(const std::filesystem::path& folder);

    /// Reads models and adds each at the end, beside what is there; those that cannot be read are told and
    /// left out.
    void addModels(const std::vector<std::filesystem::path>& files);
    /// A copy of the selected model beside it, on the X axis.
    void duplicateSelected(const LoadedScene& shown);
    void removeSelected();
    /// Files of models have changed: all are read again.
    void readAgain();
    bool isReading() const { return reading_.isAtWork() || !toAdd_.empty(); }

    /// Takes over what has been read, and gives the scene when it is no longer the one given last. A model
    /// that cannot be read is told once; the scene then stays as it was.
    std::optional<LoadedScene> update();

    /// Does it, at once or when the question about unsaved changes has been answered.
    void leave(std::function<void()> action);
    bool isAsking() const { return static_cast<bool>(asked_); }
    /// Whether the user is asked for something, or is about to be.
    bool waits() const { return dialog != Dialog::None || isAsking(); }
    void answer(Answer answer);
    /// Asks for a name when the scene has none yet. True when it has been written.
    bool save();
    bool saveAs(const std::filesystem::path& file);
    /// Whether the document has been written since the last call.
    bool takeWritten() { return std::exchange(written_, false); }

    /// Tells an edit that was refused.
    void tell(const Result<void>& edit);

  private:
    struct ReadModel {
        std::filesystem::path file;
        Result<std::shared_ptr<const OctreeAsset>> asset;
        bool add = false;
    };
    void read(std::vector<std::filesystem::path> files, bool add);
    void takeRead();
    void insert(const std::filesystem::path& file, const OctreeAsset& asset);
    void afterSave();

    MessageLog* log_;
    ModelShelf shelf_;
    Background<std::vector<ReadModel>> reading_;
    std::deque<std::filesystem::path> toAdd_;
    std::optional<std::uint64_t> given_;   ///< revision of the scene that update() gave last
    std::optional<std::uint64_t> failed_;  ///< revision with a model that cannot be read
    bool readAnew_ = false;
    WorldBounds bounds_;  ///< of the scene as given last, and what was added since
    std::function<void()> asked_;
    bool leavesAfterSave_ = false;
    bool written_ = false;
};

}  // namespace pfvox::viewer
