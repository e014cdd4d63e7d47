#pragma once

#include <cstdint>

#include "core/mesh/triangle_mesh.h"

/// Deterministic meshes that are hard on arithmetic, in metres, about one metre large.
namespace nearfit::test {

/// Each face split at a point near the middle of its first side, `aspect` times nearer than the side is long:
/// one of the three is as flat as that. Closed if the mesh was.
/// @param lift  How far that point is moved out of the face, as a fraction of its distance from the side.
TriangleMesh withSlivers(const TriangleMesh& mesh, double aspect, double lift);

/// Each face split at a point `aspect` times nearer to its first corner than the corner is to others: two of
/// the three are needles or wedges with a short side.
TriangleMesh withNeedles(const TriangleMesh& mesh, double aspect, double lift);

/// Every third face given again, every sixth of them turned round.
TriangleMesh withDuplicates(const TriangleMesh& mesh);

/// Faces without area added: on an edge with its exact middle, and on a vertex given three times.
TriangleMesh withFacesWithoutArea(const TriangleMesh& mesh);

/// A fan about the origin, its rim at random heights in [-height, height] and radii in [0.5, 1]: open.
TriangleMesh jaggedFan(std::uint64_t seed, std::uint32_t valence, double height);

/// A wedge with its edge along y, from -1 to 1 at z = 0, its sides falling below it: closed.
/// @param halfAngle  Between either side and straight down [rad].
TriangleMesh wedgeMesh(double halfAngle);

/// A square face in z = 0, corners at integers over `cells`, cut into triangles about random integer points:
/// coplanar exactly, with fans of all kinds. On a flat box, closed.
TriangleMesh coplanarFans(std::uint64_t seed, std::uint32_t cells);

/// `fins` half discs that share one edge along z, at random angles within `spread` [rad].
TriangleMesh finsMesh(std::uint64_t seed, std::uint32_t fins, double spread);

/// Random triangles, none connected.
TriangleMesh looseTriangles(std::uint64_t seed, std::uint32_t count);

}  // namespace nearfit::test
