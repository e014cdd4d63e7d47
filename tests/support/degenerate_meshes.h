#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

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

/// A point with each coordinate rounded to single precision.
glm::dvec3 inSinglePrecision(const glm::dvec3& point);

/// Its coordinates rounded to single precision, as most files hold them.
TriangleMesh inSinglePrecision(const TriangleMesh& mesh);

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

/// A closed strip of squares around a plane curve of the given corners, from z = -1/2 to 1/2, closed by two
/// fans about points above and below one place. It winds around a point of the plane, near z = 0, as often as
/// the curve does.
TriangleMesh prismOver(const std::vector<glm::dvec2>& curve, const glm::dvec2& middle = glm::dvec2(0.0));

/// A figure of eight about the crossing of its two long strokes in the origin: the lobe on the right is wound
/// anticlockwise, the one on the left clockwise, smaller by `scale`.
TriangleMesh figureOfEightMesh(double scale);

/// `fins` half discs that share one edge along z, at random angles within `spread` [rad].
TriangleMesh finsMesh(std::uint64_t seed, std::uint32_t fins, double spread);

/// Random triangles, none connected.
TriangleMesh looseTriangles(std::uint64_t seed, std::uint32_t count);

/// A double pyramid around a ring that crosses itself like a bow, its apex at the origin, pointing along z.
/// Seen from there, the ring goes round a lobe of area 9 in the sense of an outside, and nearer below the
/// apex round one of area 4 in the other.
TriangleMesh crossedApexMesh();

}  // namespace nearfit::test
