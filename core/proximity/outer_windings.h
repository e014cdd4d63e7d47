#pragma once

#include <span>

#include "core/proximity/self_crossings.h"

namespace nearfit {

/// Whether no closed piece that crosses itself is seen from its inner side anywhere: how often it winds
/// around the points just outside of each of its triangles is nowhere negative. Then no point at all has a
/// negative winding number, since the least one is found outside of some triangle.
///
/// Triangles that cross nothing form patches, outside of which the number is the same everywhere; one ray
/// for each, decided exactly, tells it. On a triangle that is crossed it changes by one where another one
/// passes; beginning at a patch next to it, it is told exactly where one line of crossings cuts the triangle
/// in two, else bounded by the triangles that can be passed from behind. True is certain; false where it is
/// so or the bound does not tell, as where a triangle has no such neighbour, or where there are more than a
/// thousand patches.
///
/// @param crossings  All that findSelfCrossings() finds, in its order.
/// @param boxes      As boxesOfTriangles() makes them. The mesh is closed and oriented.
bool areOuterWindingsPositive(const TriangleMesh& mesh, const MeshPieces& pieces, const BoxPairs& boxes,
                              std::span<const CrossingPair> crossings);

}  // namespace nearfit
