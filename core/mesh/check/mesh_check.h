#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/progress.h"
#include "core/math/aabb.h"
#include "core/math/triangle_corners.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Kinds of defects of a mesh.
enum class FindingKind : std::uint8_t {
  OpenEdges,            ///< A loop of edges with one face.
  HairlineCracks,       ///< Open borders nearer to each other than the tolerance.
  NonManifoldEdges,     ///< Edges with three faces or more.
  NonManifoldVertices,  ///< Vertices in which sheets of the surface touch.
  SelfIntersections,    ///< Pairs of triangles that cross or touch elsewhere than where they are joined.
  InvertedShells,       ///< Closed components that face the wrong way.
  InconsistentEdges,    ///< Edges whose two faces disagree on which side is outside.
  DegenerateFaces,      ///< Faces without area.
  DuplicateFaces,       ///< Faces with the corners of another one.
};
constexpr std::size_t kFindingKinds = 9;

/// How much a finding matters for contact.
enum class FindingSeverity : std::uint8_t {
  Note,     ///< Contact is as it should be.
  Warning,  ///< Contact is right there, but slower, or felt from both sides.
  Serious,  ///< Contact may be wrong there.
};

/// A defect in one place. Points are in the mesh's frame [m].
struct MeshFinding {
  /// Max number of edges and of triangles that are kept to show the place.
  static constexpr std::size_t kMaxShown = 1000;

  FindingKind kind{};
  FindingSeverity severity{};
  /// Loading has mended it: the part does not have it.
  bool isMended = false;
  std::uint64_t count = 0;  ///< Edges, vertices, pairs of triangles or faces; of shells their faces.
  /// OpenEdges: length of the loop. HairlineCracks: max width. Otherwise 0 [m].
  double length = 0.0;
  bool hasPlace = true;  ///< False if only the count is known; what follows is then empty.
  glm::dvec3 point{0.0};
  Aabb box;
  std::vector<std::array<glm::dvec3, 2>> edges;  ///< The first of them.
  std::vector<TriangleCorners> triangles;        ///< The same.
};

/// Sums over a kind of finding.
struct FindingTotal {
  std::uint64_t count = 0;   ///< As MeshFinding::count.
  std::uint64_t places = 0;  ///< Findings, including those left out of the list.
  bool isCut = false;        ///< A limit ended the search: there may be more.
};

/// All defects of a mesh.
struct MeshCheck {
  /// By kind, those of a kind by falling count; at most kMaxPlaces of a kind.
  std::vector<MeshFinding> findings;
  std::array<FindingTotal, kFindingKinds> totals;
  double crackTolerance = 0.0;  ///< In effect [m].

  static constexpr std::size_t kMaxPlaces = 200;

  const FindingTotal& total(FindingKind kind) const noexcept {
    return totals[static_cast<std::size_t>(kind)];
  }
  /// The worst of what loading has not mended; nullopt if there is nothing.
  std::optional<FindingSeverity> worst() const noexcept;
  /// Number of places of what loading has not mended.
  std::uint64_t places() const noexcept;
};

/// Defects to look for, and limits of the search.
struct MeshCheckOptions {
  /// Max width of a hairline crack [m]; finite, >= 0. 0: kCrackShare of the mesh's diagonal.
  double crackTolerance = 0.0;
  /// Max number of pairs of triangles that are listed as crossing.
  std::size_t maxIntersections = 10'000;
};
/// Default width of hairline cracks, as a fraction of the diagonal: well above the rounding of files in single
/// precision (1e-7) and below any slot that is meant.
constexpr double kCrackShare = 1e-4;

/// Checks a mesh for defects. Time and memory grow with its size, O(n log n), whatever it holds: limits end the search
/// for intersections and cracks, and the totals say so. The same mesh gives the same findings. Not for the GUI or servo
/// thread. Throws UsageError if the tolerance is invalid; Cancelled.
MeshCheck checkMesh(const TriangleMesh& mesh, const MeshCheckOptions& options = {},
                    const ProgressCallback& progress = {});

/// Adds faces that loading has left out.
/// @param count   Number of them; 0 adds nothing.
/// @param places  Some of them, as the file has them [m].
void addMended(MeshCheck& check, FindingKind kind, std::uint64_t count, std::vector<TriangleCorners> places);

/// Word for machines: "openEdges".
std::string_view wordOf(FindingKind kind) noexcept;
/// Word for people and machines: "note", "warning", "serious".
std::string_view wordOf(FindingSeverity severity) noexcept;

}  // namespace nearfit
