#pragma once

#include <span>

#include "core/proximity/surface/self_crossings.h"

namespace nearfit {

/// True if no closed component that crosses itself shows its inner side anywhere: its winding number just
/// outside each of its triangles is never negative. Then no point at all has a negative winding number, since
/// the min occurs just outside some triangle.
///
/// Triangles that cross nothing form patches, just outside of which the winding number is constant; one
/// exactly decided ray per patch gives it. On a crossed triangle the number changes by one wherever another
/// triangle passes through. Starting from an adjacent patch, it is exact if a single line of crossings cuts
/// the triangle in two; else the number of triangles that can be passed from behind bounds it. True is
/// certain. False may also mean that the bound does not decide, as for a triangle without an adjacent patch,
/// that there are more than a thousand patches, or that their rays would take more than some seconds.
///
/// @param mesh       Closed and oriented.
/// @param crossings  All that findSelfCrossings() finds, in its order.
bool areOuterWindingsPositive(const TriangleMesh& mesh, const MeshComponents& pieces, const PieceBoxes& boxes,
                              std::span<const CrossingPair> crossings);

}  // namespace nearfit
