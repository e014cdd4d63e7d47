#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace nearfit {

/// The open scene and the commands that change it, shared by GUI, CLI and scripts. Every command is one step
/// of undo, and either happens whole or throws UsageError and changes nothing. A command that would leave
/// everything as it is is no step. One thread only.
class Session {
 public:
  /// States that undo can go back through; older ones are forgotten.
  static constexpr std::size_t kMaxUndo = 1000;

  const Scene& scene() const noexcept { return current_.scene; }

  /// A part for a loaded mesh, with the next colour of the palette; at the identity pose unless given.
  /// A name that is taken gets a number behind it.
  PartId addPart(PartGeometryPtr geometry, const std::string& name, const RigidTransform& worldFromPart = {});
  /// A copy in the same place, unlocked, of the next colour, its name with a number behind it.
  PartId duplicatePart(PartId id);
  void deletePart(PartId id);
  void renamePart(PartId id, const std::string& name);
  /// @param verb  What undo calls the step, before the part's name.
  void movePart(PartId id, const RigidTransform& worldFromPart, const std::string& verb = "Move");
  void setColour(PartId id, const Colour& colour);
  void setDensity(PartId id, double density);
  /// Also for locked parts: what is shown is no property of the part.
  void setVisible(PartId id, bool visible);
  void setLocked(PartId id, bool locked);
  void setMovingPart(std::optional<PartId> id);
  /// Undo calls it by what changes: the mode, the springs, or how contact feels.
  void setHaptics(const HapticSettings& haptics);

  /// Replaces everything, forgets undo. `file` is empty for a new, unnamed scene.
  void reset(Scene scene = {}, const std::filesystem::path& file = {});
  /// Writes the scene and takes that file as its own. Throws FileError.
  void save(const std::filesystem::path& file);
  const std::filesystem::path& file() const noexcept { return file_; }
  /// Whether the scene differs from what was last saved or reset; undo back to there makes it false again.
  bool isModified() const noexcept { return current_.serial != savedSerial_; }

  bool canUndo() const noexcept { return !past_.empty(); }
  bool canRedo() const noexcept { return !future_.empty(); }
  /// What undo would take back, as a short phrase ("Move Peg"); empty when there is nothing.
  std::string undoText() const { return past_.empty() ? std::string() : current_.label; }
  std::string redoText() const { return future_.empty() ? std::string() : future_.back().label; }
  /// Does nothing when there is nothing to undo; so does redo.
  void undo();
  void redo();

  /// Called after every change of the scene, the file or the modified mark, on the thread that made it.
  void onChange(std::function<void()> listener);

 private:
  struct State {
    Scene scene;
    std::string label;         ///< What led to this state.
    std::uint64_t serial = 0;  ///< Different for each state, so that the saved one is recognised.
  };
  void commit(Scene scene, std::string label);
  void commitReplaced(Part part, std::string label);
  /// A copy to change. Throws UsageError when there is no such part.
  Part existingPart(PartId id) const;
  /// As existingPart; also throws when it is locked.
  Part unlockedPart(PartId id) const;
  void notify() const;

  State current_;
  std::deque<State> past_;     ///< Oldest first.
  std::vector<State> future_;  ///< The next to redo last.
  std::uint64_t savedSerial_ = 0, nextSerial_ = 1;
  std::filesystem::path file_;
  std::vector<std::function<void()>> listeners_;
};

}  // namespace nearfit
