#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/new_nodes.h"
#include "core/scene/scene.h"
#include "core/scene/scene_tree.h"
#include "core/session/scene_events.h"
#include "core/session/session_command.h"

namespace nearfit {

/// The open scene and the commands that change it, shared by GUI, CLI and scripts.
///
/// Each command is one undo step, except setPairRecords(). It either succeeds as a whole or throws UsageError and changes nothing.
/// No-ops record no undo step. A command on several parts fails if any of them is locked, unless it only
/// changes how parts are shown or locked. Single-threaded. Poses are in the world frame; SI units.
class Session {
 public:
  /// Max number of undo steps; older states are dropped.
  static constexpr std::size_t kMaxUndo = 1000;

  const Scene& scene() const noexcept { return current_.scene; }

  /// Carries out a command that is given as a value, by the function below that it stands for; throws what that throws.
  void apply(const SessionCommand& command);

  /// Adds a part for a loaded mesh in the next colour of the palette. Appends a number if the name is taken.
  PartId addPart(PartGeometryPtr geometry, const std::string& name, const RigidTransform& worldFromPart = {});
  struct NewPart {
    PartGeometryPtr geometry;
    std::string name;
  };
  /// Adds several parts in one step, at the identity pose; otherwise like addPart().
  std::vector<PartId> addParts(const std::vector<NewPart>& parts);
  /// Adds parts and groups, such as the instances and assemblies of documents, in one step; see addTo(). Returns those
  /// at the top level.
  SceneNodes addNodes(const NewNodes& nodes);
  /// Copies a part in place: unlocked, without joints, in the next colour, with a number appended to its name.
  PartId duplicatePart(PartId id) { return duplicate({{id}, {}}).parts.front(); }
  /// Deletes a part. If it is the moving part, the scene no longer has one.
  void deletePart(PartId id) { deleteNodes({{id}, {}}); }
  /// Renames a part. Throws UsageError if another part has the name.
  void renamePart(PartId id, const std::string& name);
  /// Moves a part to a pose, on its joints or not: JointSet::nearestPose() finds the pose that is. Parts that are kept
  /// on it stay behind.
  /// @param verb  First word of the undo label; the part's name follows.
  void movePart(PartId id, const RigidTransform& worldFromPart, const std::string& verb = "Move") {
    moveParts({id}, id, worldFromPart, verb);
  }
  void setColour(PartId id, const Colour& colour) { setColour(std::vector{id}, colour); }
  /// @param density  [kg/m^3]; kMinDensity to kMaxDensity.
  void setDensity(PartId id, double density) { setDensity(std::vector{id}, density); }
  using NewGeometry = steps::NewGeometry;
  /// Replaces the geometry of parts whose files changed, in one step; poses and joints stay. Also works on locked
  /// parts, since the file decides what it holds.
  void reloadParts(const std::vector<NewGeometry>& parts);
  /// Replaces geometry by repaired copies, in one step; poses, pivots and joints stay.
  void repairParts(const std::vector<NewGeometry>& parts);
  /// Replaces geometry by the same meshes in another unit, in one step. Pivots, and the points of joints on the parts,
  /// scale with the meshes. Poses stay, but positions of parts whose document mayBeInWrongUnit() scale about the world's
  /// origin, and so do the points in the world that joints keep these parts on: the document lies as if it had been
  /// opened in the new unit.
  void rescaleParts(const std::vector<NewGeometry>& parts);
  /// Replaces geometry by the same shapes in another tessellation, in one step. Poses, pivots and joints stay.
  void refineParts(const std::vector<NewGeometry>& parts);
  /// Also works on locked parts: visibility is how a part is shown, not what it is.
  void setVisible(PartId id, bool visible) { setVisible(std::vector{id}, visible); }
  void setLocked(PartId id, bool locked) { setLocked({{id}, {}}, locked); }
  /// Adds a joint and moves its part to this pose, on the joint, in one step. Throws UsageError like
  /// Scene::addJoint(), and if the pose is invalid.
  JointId addJoint(const Joint& joint, const RigidTransform& worldFromPart);
  /// Removes joints; their parts stay where they are.
  void removeJoints(const std::vector<JointId>& ids);
  /// Turns joints on or off; their parts stay where they are.
  void setJointsOn(const std::vector<JointId>& ids, bool on);
  /// Sets the rules for pairs of parts in checks of the scene. Throws UsageError like Scene::setPairRules().
  void setPairRules(const std::vector<PairRule>& rules);
  /// Keeps what a check of the scene found, with the present state instead of as a step of its own: undo and redo lead
  /// from it and back to it, and the scene is modified. Throws UsageError like Scene::setPairRecords().
  void setPairRecords(const std::vector<PairRecord>& records);
  /// Sets what the user says about findings; parts may be locked. Throws UsageError if one of the pairs has no record, or
  /// like checkPairRecord().
  /// @param reason  Why they are accepted; else may be empty.
  void setFindingState(const std::vector<PartPair>& pairs, FindingState state,
                       const std::string& reason = {});
  /// Sets the moving part; std::nullopt for none. Throws UsageError if the part is locked.
  void setMovingPart(std::optional<PartId> id);
  /// Makes all parts in a group move as one. Throws UsageError like Scene::setMovingGroup().
  void setMovingGroup(GroupId id);
  /// Puts what is in hand where the moving part gets exactly this pose; the parts of a moving group move rigidly along.
  /// No-op if nothing is in hand.
  void moveMoving(const RigidTransform& worldFromPart, const std::string& verb = "Move");
  /// @param label  Undo label; if empty, one that names the change.
  void setHaptics(const HapticSettings& haptics, const std::string& label = {});

  /// Moves parts rigidly together so that `lead`, one of them, gets exactly this pose.
  void moveParts(const std::vector<PartId>& ids, PartId lead, const RigidTransform& worldFromLead,
                 const std::string& verb = "Move");
  /// Also works on locked parts.
  void setVisible(const std::vector<PartId>& ids, bool visible);
  /// Also works on locked parts.
  void setColour(const std::vector<PartId>& ids, const Colour& colour);
  /// Also works on locked parts.
  /// @param opacity  kMinOpacity to 1.
  void setOpacity(const std::vector<PartId>& ids, double opacity);
  /// @param density  [kg/m^3]; kMinDensity to kMaxDensity.
  void setDensity(const std::vector<PartId>& ids, double density);
  using NewPivot = steps::NewPivot;
  /// Sets or, with std::nullopt, resets pivots.
  void setPivots(const std::vector<NewPivot>& pivots);
  /// Shows only these parts, locked ones included. endIsolation() restores the visibility from
  /// before the first call.
  void isolate(const std::vector<PartId>& ids);
  /// Restores the visibility from before isolate(); no-op if not isolated.
  void endIsolation();

  /// Sets the nodes' own locks; members of a group keep theirs. If this locks what the hand moves, or something in the
  /// moving group, nothing is in hand any more.
  void setLocked(const SceneNodes& nodes, bool locked);
  /// Renames a group; groups may share a name.
  void renameGroup(GroupId id, const std::string& name);
  /// Deletes nodes; groups with all they hold. Joints of these parts, and on them, go too.
  void deleteNodes(const SceneNodes& nodes);
  /// Copies nodes in place, unlocked and without joints. Copies go beside the originals, or outside groups that are
  /// locked. A single part gets the next colour. Returns the copies of the `outermost` nodes.
  SceneNodes duplicate(const SceneNodes& nodes);
  /// Moves nodes into a new group, placed in the innermost group that holds them all. Appends a number if
  /// the name is taken.
  GroupId group(const SceneNodes& nodes, const std::string& name = "Group");
  /// Dissolves groups; their members move up to the groups' parents.
  void ungroup(const std::vector<GroupId>& ids);
  /// Moves nodes into group `target`; std::nullopt means the top level.
  void regroup(const SceneNodes& nodes, std::optional<GroupId> target);

  /// Replaces the scene and clears undo. `file` is empty for a new, unnamed scene.
  void reset(Scene scene = {}, const std::filesystem::path& file = {});
  /// Like reset(), for a scene that is in no file as it is, such as one that was lost before it was saved: it stays
  /// modified until save().
  void restore(Scene scene, const std::filesystem::path& file);
  /// Writes the scene and makes `file` the session's file. Throws FileError.
  void save(const std::filesystem::path& file);
  /// The session's file; empty if the scene was never saved.
  const std::filesystem::path& file() const noexcept { return file_; }
  /// Changes on each reset and restore. Earlier PartIds and GroupIds become invalid.
  std::uint64_t sceneSerial() const noexcept { return sceneSerial_; }
  /// True if the scene differs from the last saved or reset state. Undoing back to that state makes it false.
  bool isModified() const noexcept { return current_.serial != savedSerial_; }

  bool canUndo() const noexcept { return !past_.empty(); }
  bool canRedo() const noexcept { return !future_.empty(); }
  /// Label of the step that undo() reverts ("Move Peg"); empty if none.
  std::string undoText() const { return past_.empty() ? std::string() : current_.step.label; }
  /// Label of the step that redo() repeats; empty if none.
  std::string redoText() const { return future_.empty() ? std::string() : future_.back().step.label; }
  /// No-op if there is nothing to undo; likewise redo().
  void undo();
  void redo();
  /// The step that led to a state.
  struct Step {
    std::string label;  ///< As in undoText(); empty for the initial state.
    /// For steps that move parts: distance that the lead's centre of mass moved [m], and angle that the lead
    /// turned [rad]. Otherwise 0.
    double shift = 0.0, angle = 0.0;
    bool operator==(const Step&) const = default;
  };
  /// The steps that led to each state that undo and redo reach, oldest first.
  std::vector<Step> history() const;
  /// Index of the current state in history().
  std::size_t historyIndex() const noexcept { return past_.size(); }
  /// Undoes or redoes to state `index` of history(), as one change; no-op if out of range.
  void goTo(std::size_t index);
  /// A state that undo reaches, or the current one, and the way to it, for who records the session. Valid until the
  /// session changes.
  struct Reached {
    std::uint64_t step;             ///< Unique ID of the step that led there; ascends from state to state.
    std::uint64_t state;            ///< As stateSerial().
    const Scene& scene;             ///< After the step.
    const SessionCommand* command;  ///< What the step did to the scene before; null for the initial state.
    /// Records of pairs may be others than the command left.
    bool restatesRecords;
  };
  /// @param index  In history(); at most historyIndex().
  Reached reached(std::size_t index) const;
  /// Unique ID of the current state. Undo and redo restore it.
  std::uint64_t stateSerial() const noexcept { return current_.serial; }
  /// Number of steps since the last save or reset; if that state is no longer reachable, the
  /// undo depth plus one.
  std::size_t changesSinceSave() const noexcept;

  /// Calls `listener` after each change of scene, file or modified state, on the thread that made the change,
  /// as long as the subscription lives. Order and re-entrancy: see SceneEvents.
  Subscription onChange(SceneEvents::Stage stage, std::function<void()> listener) {
    return events_.subscribe(stage, std::move(listener));
  }

 private:
  struct State {
    Scene scene;
    Step step;
    std::uint64_t serial = 0;                    ///< Unique per state; identifies the saved one.
    std::uint64_t stepSerial = 0;                ///< As `serial` was when the step was done.
    std::optional<SessionCommand> command = {};  ///< None for the initial state.
    bool restatesRecords = false;                ///< See Reached.
  };
  /// Makes `scene` the current state, one undo step after the last, and notifies.
  /// @param command  What was done, as apply() does it.
  void commit(Scene scene, Step step, SessionCommand command);
  void commit(Scene scene, std::string label, SessionCommand command) {
    commit(std::move(scene), Step{std::move(label)}, std::move(command));
  }
  /// Applies `change` to a copy of each part, and then `finish`, if there is one, to the scene that has them. The label
  /// is the verb and the names of the parts that changed.
  void change(const std::vector<PartId>& ids, Step verb, SessionCommand command,
              const std::function<void(Part&)>& change, const std::function<void(Scene&)>& finish = {});
  void change(const std::vector<PartId>& ids, const char* verb, SessionCommand command,
              const std::function<void(Part&)>& change) {
    this->change(ids, Step{verb}, std::move(command), change);
  }
  /// Like change(). Throws UsageError if a part is locked, even if nothing would change.
  void changeUnlocked(const std::vector<PartId>& ids, Step verb, SessionCommand command,
                      const std::function<void(Part&)>& change,
                      const std::function<void(Scene&)>& finish = {});
  void changeUnlocked(const std::vector<PartId>& ids, const char* verb, SessionCommand command,
                      const std::function<void(Part&)>& change,
                      const std::function<void(Scene&)>& finish = {}) {
    changeUnlocked(ids, Step{verb}, std::move(command), change, finish);
  }
  /// Replaces the scene and clears undo, without notifying.
  void begin(Scene scene, const std::filesystem::path& file);
  /// Move one state back or forward, without notifying.
  void stepBack();
  void stepOn();

  State current_;
  std::deque<State> past_;     ///< Oldest first.
  std::vector<State> future_;  ///< Last element is the next to redo.
  std::uint64_t savedSerial_ = 0, nextSerial_ = 1, sceneSerial_ = 0;
  std::filesystem::path file_;
  SceneEvents events_;
};

}  // namespace nearfit
