#pragma once

#include "core/servo/servo_scene.h"

namespace nearfit {

/// Moves the moving part of a scene a little off the bodies that it touches, so that they are felt: a proxy that starts
/// on another body has no way that is proved free, and would have to release it (findClearance()). To be called before a
/// proxy starts there.
///
/// Touching are surfaces that meet no deeper than rounding, or that stand apart by no more than their flats deviate
/// (ServoScene::deviation()). The part is shifted, without rotation, by some micrometres at most (less for small parts, more
/// only where flats deviate by as much), to where it is clear of them and of all others that it was clear of. It is shifted
/// only where the straight way from there back to the start is proved free up to contact: never through a wall, and never
/// out of a body that it enters deeper. A part that touches on all sides may have no such place; it then stays, or leaves as
/// many bodies as it can.
///
/// @return True if the part was moved.
/// Needs hierarchies that are built. Joints are not considered: where one presses the part on a body, contact wins
/// anyway. Allocates; not for the servo thread.
bool startApart(ServoScene& scene);

}  // namespace nearfit
