#pragma once

#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/scene/scene.h"

namespace nearfit::ui {

class HandState;
class Selection;
class ShownPoses;

/// The parts that typed numbers and arrow keys move together.
struct PoseSubject {
  /// The last one leads: its pose is shown, and stands for all of them. Empty: there is nothing to move.
  std::vector<PartId> parts;
  bool isGroupInHand = false;  ///< They are the moving group, whose pose is that of the part that leads it.

  std::optional<PartId> lead() const noexcept {
    return parts.empty() ? std::nullopt : std::optional(parts.back());
  }
};

/// Returns the selected parts, or what is in hand, felt or not, while none is selected. All parts of the moving group
/// together are the group; while the servo moves it, any of them stands for it. O(n) in the parts of the scene.
PoseSubject poseSubjectOf(const Scene& scene, const Selection& selection, const HandState& hand);
/// Returns the part whose pose stands for all that are selected: of one group the part that leads it, in hand or not
/// (leadOfGroup()), else the one selected last. O(n) in the parts of the scene.
/// @param selection  Has parts.
PartId leadOf(const Scene& scene, const Selection& selection);

/// Returns the pivot of the subject in the frame of the part that leads it [m]: the one that its parts share, else their
/// centre of mass; of the group in hand that of its visible parts.
glm::dvec3 pivotInLead(const Scene& scene, const PoseSubject& subject, const ShownPoses& poses);

}  // namespace nearfit::ui
