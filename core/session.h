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
#include "core/scene/scene_tree.h"

namespace nearfit {

/// The open scene and the commands that change it, shared by GUI, CLI and scripts. Every command is one step
/// of undo, and either happens whole or throws UsageError and changes nothing. A command that would leave
/// everything as it is is no step. One that is about several parts is refused when one of them is locked, and
/// so is every other that would change a locked part but for how it is shown. One thread only.
class Session {
 public:
  /// States that undo can go back through; older ones are forgotten.
  static constexpr std::size_t kMaxUndo = 1000;

  const Scene& scene() const noexcept { return current_.scene; }

  /// A part for a loaded mesh, with the next colour of the palette; at the identity pose unless given.
  /// A name that is taken gets a number behind it.
  PartId addPart(PartGeometryPtr geometry, const std::string& name, const RigidTransform& worldFromPart = {});
  struct NewPart {
    PartGeometryPtr geometry;
    std::string name;
  };
  /// Several at once, each as addPart does. None at all is no step.
  std::vector<PartId> addParts(const std::vector<NewPart>& parts);
  /// A copy in the same place, unlocked, of the next colour, its name with a number behind it.
  PartId duplicatePart(PartId id) { return duplicate({{id}, {}}).parts.front(); }
  void deletePart(PartId id) { deleteNodes({{id}, {}}); }
  void renamePart(PartId id, const std::string& name);
  /// @param verb  What undo calls the step, before the part's name.
  void movePart(PartId id, const RigidTransform& worldFromPart, const std::string& verb = "Move") {
    moveParts({id}, id, worldFromPart, verb);
  }
  void setColour(PartId id, const Colour& colour) { setColour(std::vector{id}, colour); }
  void setDensity(PartId id, double density) { setDensity(std::vector{id}, density); }
  struct NewGeometry {
    PartId part;
    PartGeometryPtr geometry;
  };
  /// Parts whose files have changed get what those hold now, as one step; poses stay. Also of locked parts:
  /// what a file holds is not the scene's to lock.
  void reloadParts(const std::vector<NewGeometry>& parts);
  /// The same meshes in another unit of length, as one step; poses stay, pivots are where they were on them.
  void rescaleParts(const std::vector<NewGeometry>& parts);
  /// Also for locked parts: what is shown is no property of the part.
  void setVisible(PartId id, bool visible) { setVisible(std::vector{id}, visible); }
  void setLocked(PartId id, bool locked) { setLocked({{id}, {}}, locked); }
  void setMovingPart(std::optional<PartId> id);
  /// @param label  What undo calls it; empty: by what changes.
  void setHaptics(const HapticSettings& haptics, const std::string& label = {});

  /// Moves parts rigidly together, so that one of them, the lead, comes to stand exactly there.
  void moveParts(const std::vector<PartId>& ids, PartId lead, const RigidTransform& worldFromLead,
                 const std::string& verb = "Move");
  void setVisible(const std::vector<PartId>& ids, bool visible);
  void setColour(const std::vector<PartId>& ids, const Colour& colour);  ///< Also for locked parts.
  /// Also for locked parts.
  void setOpacity(const std::vector<PartId>& ids, double opacity);
  void setDensity(const std::vector<PartId>& ids, double density);
  struct NewPivot {
    PartId part;
    std::optional<glm::dvec3> inPart;  ///< As Part::pivot.
  };
  void setPivots(const std::vector<NewPivot>& pivots);
  /// Shows these alone, also locked ones; endIsolation shows exactly what was visible before the first one.
  void isolate(const std::vector<PartId>& ids);
  void endIsolation();

  /// The nodes' own locks: what a group holds keeps its own. Whoever locks what is in hand puts it down.
  void setLocked(const SceneNodes& nodes, bool locked);
  void renameGroup(GroupId id, const std::string& name);
  /// Groups with all that they hold.
  void deleteNodes(const SceneNodes& nodes);
  /// Copies in the same place, unlocked, beside the originals or outside of the groups that are locked; a
  /// part alone gets the next colour. Returns the copies of `outermost` nodes.
  SceneNodes duplicate(const SceneNodes& nodes);
  /// Puts them into a new group in the innermost one that holds all of them.
  GroupId group(const SceneNodes& nodes, const std::string& name = "Group");
  /// What the groups hold takes their place.
  void ungroup(const std::vector<GroupId>& ids);
  /// Puts nodes into a group, or at the top.
  void regroup(const SceneNodes& nodes, std::optional<GroupId> target);

  /// Replaces everything, forgets undo. `file` is empty for a new, unnamed scene.
  void reset(Scene scene = {}, const std::filesystem::path& file = {});
  /// As reset, but of a scene that was not saved when it was lost: it is modified, whatever is undone.
  void restore(Scene scene, const std::filesystem::path& file);
  /// Writes the scene and takes that file as its own. Throws FileError.
  void save(const std::filesystem::path& file);
  const std::filesystem::path& file() const noexcept { return file_; }
  /// Another number after each reset and restore: the ids of before then mean other parts, or none.
  std::uint64_t sceneSerial() const noexcept { return sceneSerial_; }
  /// Whether the scene differs from what was last saved or reset; undo back to there makes it false again.
  bool isModified() const noexcept { return current_.serial != savedSerial_; }

  bool canUndo() const noexcept { return !past_.empty(); }
  bool canRedo() const noexcept { return !future_.empty(); }
  /// What undo would take back, as a short phrase ("Move Peg"); empty when there is nothing.
  std::string undoText() const { return past_.empty() ? std::string() : current_.step.label; }
  std::string redoText() const { return future_.empty() ? std::string() : future_.back().step.label; }
  /// Does nothing when there is nothing to undo; so does redo.
  void undo();
  void redo();
  /// What led to a state.
  struct Step {
    std::string label;  ///< As undoText says it; empty: the scene was opened or made so.
    /// Of a step that moves parts, how far the lead's centre of mass went [m], and how far it turned [rad];
    /// zero for all others.
    double shift = 0.0, angle = 0.0;
    bool operator==(const Step&) const = default;
  };
  /// Of each state that undo and redo reach, oldest first.
  std::vector<Step> history() const;
  /// Where in the history the scene is.
  std::size_t historyIndex() const noexcept { return past_.size(); }
  /// Undoes or redoes up to that state of the history, as one change; does nothing when there is none.
  void goTo(std::size_t index);
  /// Changes with each state, and comes back with it: tells whether the scene is one that is known already.
  std::uint64_t stateSerial() const noexcept { return current_.serial; }
  /// Steps from what was last saved or reset; where that is forgotten, all that undo knows and one more.
  std::size_t changesSinceSave() const noexcept;

  /// Called after every change of the scene, the file or the modified mark, on the thread that made it.
  void onChange(std::function<void()> listener);

 private:
  struct State {
    Scene scene;
    Step step;
    std::uint64_t serial = 0;  ///< Different for each state, so that the saved one is recognised.
  };
  void commit(Scene scene, Step step);
  void commit(Scene scene, std::string label) { commit(std::move(scene), Step{std::move(label)}); }
  /// Changes copies of the parts; the label is the step's verb and those that are different then.
  void change(const std::vector<PartId>& ids, Step verb, const std::function<void(Part&)>& change);
  void change(const std::vector<PartId>& ids, const char* verb, const std::function<void(Part&)>& change) {
    this->change(ids, Step{verb}, change);
  }
  /// As change. Throws UsageError when one of them is locked, even if nothing would change.
  void changeUnlocked(const std::vector<PartId>& ids, Step verb, const std::function<void(Part&)>& change);
  void changeUnlocked(const std::vector<PartId>& ids, const char* verb,
                      const std::function<void(Part&)>& change) {
    changeUnlocked(ids, Step{verb}, change);
  }
  void notify() const;
  /// Another scene takes the place of this one, and there is nothing to undo.
  void begin(Scene scene, const std::filesystem::path& file);
  /// One state back or on, without telling.
  void stepBack();
  void stepOn();

  State current_;
  std::deque<State> past_;     ///< Oldest first.
  std::vector<State> future_;  ///< The next to redo last.
  std::uint64_t savedSerial_ = 0, nextSerial_ = 1, sceneSerial_ = 0;
  std::filesystem::path file_;
  std::vector<std::function<void()>> listeners_;
};

}  // namespace nearfit
