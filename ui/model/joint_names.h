#pragma once

#include <QString>
#include <vector>

#include "core/scene/scene.h"

namespace nearfit::ui {

/// Returns the joints of these parts, oldest first.
std::vector<Joint> jointsOfParts(const Scene& scene, const std::vector<PartId>& parts);

/// Returns what a joint does: "Kept on axis of Base".
QString jointText(const Scene& scene, const Joint& joint);
/// Number of letters of jointText() before the name of the base.
int startOfJointText(const Scene& scene, const Joint& joint);

/// Returns the same for all these joints, one per line, those that are off marked; empty if there are none.
QString jointTexts(const Scene& scene, const std::vector<Joint>& joints);

/// Returns why parts could not be moved as wanted, for the status bar: "Peg is kept on axis of Base: it moves along it
/// and turns about it". Names the first joint that is on and not between these parts; empty if there is none.
QString heldText(const Scene& scene, const std::vector<PartId>& parts);

}  // namespace nearfit::ui
