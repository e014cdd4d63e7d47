#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace nearfit {

/// The open scene and the commands that change it, shared by GUI, CLI and scripts. Every command is one step of
/// undo, and either happens whole or throws UsageError and changes nothing. One thread only.
class Session {
 public:
  const Scene& scene() const noexcept { return current_.scene; }

  /// A part for a loaded mesh, at the identity pose with the next colour of the palette.
  PartId addPart(PartGeometryPtr geometry, const std::string& name);
  PartId addPart(PartGeometryPtr geometry, const std::string& name, const RigidTransform& worldFromPart);
  PartId duplicatePart(PartId id);
  void deletePart(PartId id);
  void renamePart(PartId id, const std::string& name);
  void movePart(PartId id, const RigidTransform& worldFromPart);
  void setColour(PartId id, const Colour& colour);
  void setVisible(PartId id, bool visible);
  void setLocked(PartId id, bool locked);
  void setMovingPart(std::optional<PartId> id);
  void setSprings(const SpringParameters& springs);

  /// Replaces everything, forgets undo. `file` is empty for a new, unnamed scene.
  void reset(Scene scene = {}, const std::filesystem::path& file = {});
  /// Writes the scene and takes that file as its own. Throws FileError.
  void save(const std::filesystem::path& file);
  const std::filesystem::path& file() const noexcept { return file_; }
  bool isModified() const noexcept;

  bool canUndo() const noexcept { return !past_.empty(); }
  bool canRedo() const noexcept { return !future_.empty(); }
  /// What undo would take back, as a short phrase ("Move Peg"); empty when there is nothing.
  std::string undoText() const { return past_.empty() ? std::string() : current_.label; }
  std::string redoText() const { return future_.empty() ? std::string() : future_.back().label; }
  void undo();
  void redo();

  /// Called after every change of the scene, the file or the modified mark, on the thread that made it.
  void onChange(std::function<void()> listener);

 private:
  struct State {
    Scene scene;
    std::string label;          ///< What led to this state.
    std::uint64_t serial = 0;   ///< Different for each state, so that the saved one is recognised.
  };
  void commit(Scene scene, std::string label);
  Part unlockedPart(PartId id) const;
  void notify() const;

  State current_;
  std::vector<State> past_, future_;
  std::uint64_t savedSerial_ = 0, nextSerial_ = 1;
  std::filesystem::path file_;
  std::vector<std::function<void()>> listeners_;
};

}  // namespace nearfit
