#pragma once

#include "core/math/rigid_transform.h"

namespace nearfit {

class NormalConeTree;
struct Interference;

/// True if two bodies meet, but a translation of the part by `tolerance` separates them: they touch, or overlap by
/// less than that. Tries some directions, found from the normals of triangles that meet; false for bodies that hold
/// each other from all sides, such as a peg exactly as wide as its hole.
///
/// @param scene, part    As for findInterference().
/// @param sceneFromPart  Unit quaternion. Throws UsageError if it is not finite.
/// @param tolerance      [m]; > 0.
/// Takes up to ten times as long as findInterference(): not for the servo thread.
bool doOnlyTouch(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
                 double tolerance);
/// The same for bodies of which it is known how they meet, which is then not searched again.
/// @param found  findInterference() of these bodies at this pose.
bool doOnlyTouch(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
                 double tolerance, const Interference& found);

}  // namespace nearfit
