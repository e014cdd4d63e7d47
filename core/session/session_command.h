#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "core/scene/new_nodes.h"
#include "core/scene/scene.h"
#include "core/scene/scene_tree.h"

/// The commands of a Session as values: what an undo step keeps, a recorder writes and a script gives. Each has the
/// arguments of the function of Session that carries it out, and the name that it has in scripts
/// (resources/docs/scripts.md).
namespace nearfit::steps {

struct AddNodes {
  static constexpr const char* kName = "add";
  NewNodes nodes;
};
struct DeleteNodes {
  static constexpr const char* kName = "delete";
  SceneNodes nodes;
};
struct Duplicate {
  static constexpr const char* kName = "duplicate";
  SceneNodes nodes;
};
struct RenamePart {
  static constexpr const char* kName = "renamePart";
  PartId part{};
  std::string name;
};
struct RenameGroup {
  static constexpr const char* kName = "renameGroup";
  GroupId group{};
  std::string name;
};
struct MoveParts {
  static constexpr const char* kName = "move";
  std::vector<PartId> parts;
  PartId lead{};
  RigidTransform worldFromLead;
  std::string verb;
};
struct SetColour {
  static constexpr const char* kName = "colour";
  std::vector<PartId> parts;
  Colour colour;
};
struct SetOpacity {
  static constexpr const char* kName = "opacity";
  std::vector<PartId> parts;
  double opacity = 1.0;
};
struct SetDensity {
  static constexpr const char* kName = "density";
  std::vector<PartId> parts;
  double density = kDefaultDensity;  ///< [kg/m^3]
};
struct SetVisible {
  static constexpr const char* kName = "visible";
  std::vector<PartId> parts;
  bool isVisible = true;
};
struct NewPivot {
  PartId part{};
  std::optional<glm::dvec3> inPart;  ///< As Part::pivot.
};
struct SetPivots {
  static constexpr const char* kName = "pivot";
  std::vector<NewPivot> pivots;
};
struct NewGeometry {
  PartId part{};
  PartGeometryPtr geometry;
};
struct ReloadParts {
  static constexpr const char* kName = "reload";
  std::vector<NewGeometry> parts;
};
struct RepairParts {
  static constexpr const char* kName = "repair";
  std::vector<NewGeometry> parts;
};
struct RescaleParts {
  static constexpr const char* kName = "unit";
  std::vector<NewGeometry> parts;
};
struct RefineParts {
  static constexpr const char* kName = "refine";
  std::vector<NewGeometry> parts;
};
struct Isolate {
  static constexpr const char* kName = "isolate";
  std::vector<PartId> parts;
};
struct EndIsolation {
  static constexpr const char* kName = "endIsolation";
};
struct SetLocked {
  static constexpr const char* kName = "lock";
  SceneNodes nodes;
  bool isLocked = true;
};
struct GroupNodes {
  static constexpr const char* kName = "group";
  SceneNodes nodes;
  std::string name;
};
struct Ungroup {
  static constexpr const char* kName = "ungroup";
  std::vector<GroupId> groups;
};
struct Regroup {
  static constexpr const char* kName = "regroup";
  SceneNodes nodes;
  std::optional<GroupId> target;
};
struct AddJoint {
  static constexpr const char* kName = "addJoint";
  Joint joint;
  RigidTransform worldFromPart;
};
struct RemoveJoints {
  static constexpr const char* kName = "removeJoints";
  std::vector<JointId> joints;
};
struct SetJointsOn {
  static constexpr const char* kName = "jointsOn";
  std::vector<JointId> joints;
  bool isOn = true;
};
struct SetPairRules {
  static constexpr const char* kName = "rules";
  std::vector<PairRule> rules;
};
/// The only one that is no undo step.
struct SetPairRecords {
  static constexpr const char* kName = "records";
  std::vector<PairRecord> records;
};
struct SetFindingState {
  static constexpr const char* kName = "finding";
  std::vector<PartPair> pairs;
  FindingState state = FindingState::New;
  std::string reason;
};
struct SetMovingPart {
  static constexpr const char* kName = "movingPart";
  std::optional<PartId> part;
};
struct SetMovingGroup {
  static constexpr const char* kName = "movingGroup";
  GroupId group{};
};
struct SetHaptics {
  static constexpr const char* kName = "haptics";
  HapticSettings haptics;
  std::string label;
};

}  // namespace nearfit::steps

namespace nearfit {

/// A new kind of step needs its struct here, since Session::commit() asks for one; Session::apply() and the two
/// directions of command_json.h do not compile without it.
using SessionCommand =
    std::variant<steps::AddNodes, steps::DeleteNodes, steps::Duplicate, steps::RenamePart, steps::RenameGroup,
                 steps::MoveParts, steps::SetColour, steps::SetOpacity, steps::SetDensity, steps::SetVisible,
                 steps::SetPivots, steps::ReloadParts, steps::RepairParts, steps::RescaleParts,
                 steps::RefineParts, steps::Isolate, steps::EndIsolation, steps::SetLocked, steps::GroupNodes,
                 steps::Ungroup, steps::Regroup, steps::AddJoint, steps::RemoveJoints, steps::SetJointsOn,
                 steps::SetPairRules, steps::SetPairRecords, steps::SetFindingState, steps::SetMovingPart,
                 steps::SetMovingGroup, steps::SetHaptics>;

}  // namespace nearfit
