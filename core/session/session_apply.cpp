// Commands that are given as values.
#include <variant>

#include "core/session/session.h"

namespace nearfit {
namespace {

/// Has the session carry out each kind of command by its function.
class CommandApplier {
 public:
  explicit CommandApplier(Session& session) : session_(session) {}

  void operator()(const steps::AddNodes& c) const { session_.addNodes(c.nodes); }
  void operator()(const steps::DeleteNodes& c) const { session_.deleteNodes(c.nodes); }
  void operator()(const steps::Duplicate& c) const { session_.duplicate(c.nodes); }
  void operator()(const steps::RenamePart& c) const { session_.renamePart(c.part, c.name); }
  void operator()(const steps::RenameGroup& c) const { session_.renameGroup(c.group, c.name); }
  void operator()(const steps::MoveParts& c) const {
    session_.moveParts(c.parts, c.lead, c.worldFromLead, c.verb);
  }
  void operator()(const steps::SetColour& c) const { session_.setColour(c.parts, c.colour); }
  void operator()(const steps::SetOpacity& c) const { session_.setOpacity(c.parts, c.opacity); }
  void operator()(const steps::SetDensity& c) const { session_.setDensity(c.parts, c.density); }
  void operator()(const steps::SetVisible& c) const { session_.setVisible(c.parts, c.isVisible); }
  void operator()(const steps::SetPivots& c) const { session_.setPivots(c.pivots); }
  void operator()(const steps::ReloadParts& c) const { session_.reloadParts(c.parts); }
  void operator()(const steps::RepairParts& c) const { session_.repairParts(c.parts); }
  void operator()(const steps::RescaleParts& c) const { session_.rescaleParts(c.parts); }
  void operator()(const steps::RefineParts& c) const { session_.refineParts(c.parts); }
  void operator()(const steps::Isolate& c) const { session_.isolate(c.parts); }
  void operator()(const steps::EndIsolation&) const { session_.endIsolation(); }
  void operator()(const steps::SetLocked& c) const { session_.setLocked(c.nodes, c.isLocked); }
  void operator()(const steps::GroupNodes& c) const { session_.group(c.nodes, c.name); }
  void operator()(const steps::Ungroup& c) const { session_.ungroup(c.groups); }
  void operator()(const steps::Regroup& c) const { session_.regroup(c.nodes, c.target); }
  void operator()(const steps::AddJoint& c) const { session_.addJoint(c.joint, c.worldFromPart); }
  void operator()(const steps::RemoveJoints& c) const { session_.removeJoints(c.joints); }
  void operator()(const steps::SetJointsOn& c) const { session_.setJointsOn(c.joints, c.isOn); }
  void operator()(const steps::SetPairRules& c) const { session_.setPairRules(c.rules); }
  void operator()(const steps::SetPairRecords& c) const { session_.setPairRecords(c.records); }
  void operator()(const steps::SetFindingState& c) const {
    session_.setFindingState(c.pairs, c.state, c.reason);
  }
  void operator()(const steps::SetMovingPart& c) const { session_.setMovingPart(c.part); }
  void operator()(const steps::SetMovingGroup& c) const { session_.setMovingGroup(c.group); }
  void operator()(const steps::SetHaptics& c) const { session_.setHaptics(c.haptics, c.label); }

 private:
  Session& session_;
};

}  // namespace

void Session::apply(const SessionCommand& command) {
  std::visit(CommandApplier(*this), command);
}

}  // namespace nearfit
