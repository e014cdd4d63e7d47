#include "core/mesh/flat_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "core/exact/outline_fill.h"
#include "core/math/axes_across.h"
#include "core/math/plane_cross.h"
#include "core/math/symmetric_eigen.h"
#include "core/mesh/flat_outlines.h"
#include "core/parallel/parallel_for.h"

namespace nearfit {
namespace {

/// Max way of a vertex to where its planes meet, in tolerances. Where planes meet at a small angle that place
/// is uncertain, and fewer planes count.
constexpr double kMaxWay = 4.0;
/// Directions in which the planes of a vertex differ by less than this say nothing (squared sine).
constexpr double kNoMeeting = 1e-8;
/// A vertex lies in a plane if its distance is at most this times the largest coordinate: some roundings.
constexpr double kInPlane = 16.0 * std::numeric_limits<double>::epsilon();
/// A flat of many corners that would lose fewer of its vertices than this share stays as it is: cutting it anew
/// gains little, and its triangles may be of better shape, as those of a disc about its centre are.
constexpr std::size_t kManyCorners = 16;
constexpr double kWorthwhile = 0.25;
/// A flat that is cut anew keeps its area to this share of the square of its rim's length, besides what moves at
/// its rim.
constexpr double kAreaError = 1e-9;
/// Max attempts, each with the flats that failed before kept as they are.
constexpr int kMaxAttempts = 8;

/// Coordinates in a plane. Seen against its normal, areas that run anticlockwise are positive.
struct Axes {
  glm::dvec3 origin;
  std::array<glm::dvec3, 2> across;
  explicit Axes(const FlatPlane& plane) : origin(plane.origin), across(axesAcross(plane.normal)) {}
  glm::dvec2 map(const glm::dvec3& p) const {
    return {glm::dot(p - origin, across[0]), glm::dot(p - origin, across[1])};
  }
};

struct PointHash {
  std::size_t operator()(const glm::dvec2& p) const noexcept {
    const auto x = std::bit_cast<std::uint64_t>(p.x + 0.0), y = std::bit_cast<std::uint64_t>(p.y + 0.0);
    return static_cast<std::size_t>((x ^ (y << 1U | y >> 63U)) * 0x9E3779B97F4A7C15U >> 7U);
  }
};

/// None if the arithmetic fails: the flat then stays as it is, and the load goes on.
std::optional<FilledOutline> filledOutline(std::span<const glm::dvec2> points,
                                           std::span<const std::array<std::uint32_t, 2>> sides) {
  try {
    return fillOutline(points, sides, FillRule::Odd);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

class FlatMerger {
 public:
  FlatMerger(const TriangleMesh& mesh, double tolerance, FlatGroups groups)
      : mesh_(mesh),
        tolerance_(tolerance),
        groups_(std::move(groups)),
        isPinned_(groups_.planes.size(), false),
        inPlane_(kInPlane * mesh.bounds().largestCoordinate()) {
    listTriangles();
  }

  std::optional<FlatMesh> merge() {
    outlines_ = findOutlines(mesh_, groups_, tolerance_, isPinned_);
    bool hasPinned = pinUnworthy();
    for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
      if (hasPinned) outlines_ = findOutlines(mesh_, groups_, tolerance_, isPinned_);
      hasPinned = true;  // By each attempt that fails.
      snapVertices();
      if (!cutAll()) continue;
      FlatMesh merged = assemble();
      if (isSound(merged)) return merged;
    }
    return std::nullopt;
  }

 private:
  void listTriangles() {
    firstTriangle_.assign(groups_.planes.size() + 1, 0);
    for (const std::uint32_t flat : groups_.flatOf) {
      if (flat != kNoFlat) ++firstTriangle_[flat + 1];
    }
    for (std::size_t i = 1; i < firstTriangle_.size(); ++i)
      firstTriangle_[i] += firstTriangle_[i - 1];
    triangles_.resize(firstTriangle_.back());
    std::vector<std::uint32_t> next(firstTriangle_.begin(), firstTriangle_.end() - 1);
    for (std::uint32_t t = 0; t < groups_.flatOf.size(); ++t) {
      if (groups_.flatOf[t] != kNoFlat) triangles_[next[groups_.flatOf[t]]++] = t;
    }
  }
  std::span<const std::uint32_t> trianglesOf(std::size_t flat) const {
    return std::span(triangles_)
        .subspan(firstTriangle_[flat], firstTriangle_[flat + 1] - firstTriangle_[flat]);
  }

  /// Number of different corners of a flat's triangles, and of those that are dropped.
  struct CornerCount {
    std::size_t all = 0, dropped = 0;
  };
  CornerCount countCorners(std::size_t flat) const {
    CornerCount count;
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t t : trianglesOf(flat))
      corners.insert(corners.end(), mesh_.triangles()[t].begin(), mesh_.triangles()[t].end());
    std::ranges::sort(corners);
    const auto repeated = std::ranges::unique(corners);
    corners.erase(repeated.begin(), repeated.end());
    count.all = corners.size();
    for (const std::uint32_t v : corners)
      count.dropped += outlines_.isKept[v] ? 0 : 1;
    return count;
  }

  /// Pins the flats that are not worth cutting anew; true if there are any.
  bool pinUnworthy() {
    bool isAny = false;
    for (std::size_t flat = 0; flat < isPinned_.size(); ++flat) {
      const CornerCount count = countCorners(flat);
      const bool hasManyCorners = count.all - count.dropped >= kManyCorners;
      isPinned_[flat] =
          hasManyCorners && static_cast<double>(count.dropped) < kWorthwhile * static_cast<double>(count.all);
      isAny = isAny || isPinned_[flat];
    }
    return isAny;
  }

  /// Moves each kept vertex to where the planes of its flats meet, if that is near and certain.
  void snapVertices() {
    positions_.assign(mesh_.vertices().begin(), mesh_.vertices().end());
    maxWay_ = 0.0;
    std::vector<std::uint32_t> flats;
    for (std::uint32_t v = 0; v < positions_.size(); ++v) {
      if (!outlines_.isKept[v]) continue;
      flats.clear();
      for (const std::uint32_t e : mesh_.edgesOfVertex(v)) {
        for (const std::uint32_t f : mesh_.facesOfEdge(e)) {
          const std::uint32_t flat = groups_.flatOf[f];
          if (flat != kNoFlat && std::ranges::find(flats, flat) == flats.end()) flats.push_back(flat);
        }
      }
      // Where not all planes meet near the vertex, the flats of many triangles come first.
      std::ranges::sort(flats, [this](std::uint32_t a, std::uint32_t b) {
        const std::size_t na = trianglesOf(a).size(), nb = trianglesOf(b).size();
        return na != nb ? na > nb : a < b;
      });
      for (std::size_t count = flats.size(); count > 0; --count) {
        const auto meeting = meetingNear(mesh_.vertices()[v], std::span(flats).first(count));
        if (!meeting) continue;
        positions_[v] = *meeting;
        maxWay_ = std::max(maxWay_, glm::distance(*meeting, mesh_.vertices()[v]));
        break;
      }
    }
  }

  /// The point nearest to `start` that lies in all of the planes; none if there is none near.
  std::optional<glm::dvec3> meetingNear(const glm::dvec3& start, std::span<const std::uint32_t> flats) const {
    glm::dvec3 p = start;
    // The second pass takes away the rounding of the first.
    for (int pass = 0; pass < 2; ++pass) {
      glm::dmat3 normals(0.0);
      glm::dvec3 pull(0.0);
      for (const std::uint32_t flat : flats) {
        const FlatPlane& plane = groups_.planes[flat];
        normals += glm::outerProduct(plane.normal, plane.normal);
        pull -= plane.height(p) * plane.normal;
      }
      const SymmetricEigen eigen = symmetricEigen(normals);
      for (std::size_t i = 0; i < 3; ++i) {
        if (eigen.values[i] > kNoMeeting)
          p += glm::dot(eigen.vectors[i], pull) / eigen.values[i] * eigen.vectors[i];
      }
    }
    const bool isThere = std::ranges::all_of(flats, [&](std::uint32_t f) { return isInPlane(p, f); });
    if (!isThere || !(glm::distance(p, start) <= kMaxWay * tolerance_)) return std::nullopt;
    return p;
  }

  bool isInPlane(const glm::dvec3& p, std::size_t flat) const {
    return std::abs(groups_.planes[flat].height(p)) <= inPlane_;
  }

  /// Cuts all flats that lose vertices. False if one failed, which is then pinned.
  bool cutAll() {
    const std::size_t flats = groups_.planes.size();
    segmentsOf_.assign(flats, {});
    for (const OutlineSegment& s : outlines_.segments) {
      for (const std::uint32_t flat : s.flats) {
        if (flat != kNoFlat && !isPinned_[flat]) segmentsOf_[flat].push_back(s.ends);
      }
    }
    innerOf_.clear();
    for (const auto& [vertex, flat] : outlines_.inner)
      innerOf_[flat].push_back(vertex);
    cut_.assign(flats, {});
    std::vector<std::uint8_t> hasFailed(flats, 0);
    constexpr std::size_t kChunk = 256;
    parallelFor((flats + kChunk - 1) / kChunk, [&](std::size_t chunk) {
      for (std::size_t flat = chunk * kChunk; flat < std::min(flats, (chunk + 1) * kChunk); ++flat) {
        if (!isPinned_[flat] && !cut(flat)) hasFailed[flat] = 1;
      }
    });
    bool isDone = true;
    for (std::size_t flat = 0; flat < flats; ++flat) {
      if (hasFailed[flat] == 0) continue;
      isPinned_[flat] = true;
      isDone = false;
    }
    return isDone;
  }

  bool cut(std::size_t flat) {
    const std::span<const std::array<std::uint32_t, 2>> segments = segmentsOf_[flat];
    const auto inner = innerOf_.find(static_cast<std::uint32_t>(flat));
    const Axes axes(groups_.planes[flat]);
    // Numbers the corners, and finds them again by their coordinates.
    std::vector<glm::dvec2> points;
    std::vector<std::array<std::uint32_t, 2>> sides;
    std::unordered_map<std::uint32_t, std::uint32_t> numberOf;
    std::unordered_map<glm::dvec2, std::uint32_t, PointHash> vertexAt;
    const auto number = [&](std::uint32_t v) {
      const auto [entry, isNew] = numberOf.try_emplace(v, static_cast<std::uint32_t>(points.size()));
      if (isNew) {
        points.push_back(axes.map(positions_[v]));
        vertexAt.try_emplace(points.back(), v);
      }
      return entry->second;
    };
    for (const auto& [a, b] : segments)
      sides.push_back({number(a), number(b)});
    if (inner != innerOf_.end()) {
      for (const std::uint32_t v : inner->second)
        number(v);
    }
    if (points.size() < 3 || vertexAt.size() != points.size()) return false;
    const std::optional<FilledOutline> filled = filledOutline(points, sides);
    if (!filled) return false;
    double area = 0.0;
    for (const auto& t : filled->triangles) {
      Triangle& triangle = cut_[flat].emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const auto found = vertexAt.find(filled->points[t[k]]);
        if (found == vertexAt.end()) return false;  // Sides cross.
        triangle[k] = found->second;
      }
      const glm::dvec2 a = filled->points[t[0]];
      area += 0.5 * cross(filled->points[t[1]] - a, filled->points[t[2]] - a);
    }
    return isSameArea(flat, axes, area, points, sides);
  }

  bool isSameArea(std::size_t flat, const Axes& axes, double area, std::span<const glm::dvec2> points,
                  std::span<const std::array<std::uint32_t, 2>> sides) const {
    double before = 0.0, rim = 0.0;
    for (const std::uint32_t t : trianglesOf(flat)) {
      const Triangle& c = mesh_.triangles()[t];
      const glm::dvec2 a = axes.map(mesh_.vertices()[c[0]]);
      before += 0.5 * cross(axes.map(mesh_.vertices()[c[1]]) - a, axes.map(mesh_.vertices()[c[2]]) - a);
    }
    for (const auto& [from, to] : sides)
      rim += glm::distance(points[from], points[to]);
    return std::abs(area - before) <= kMaxWay * tolerance_ * rim + kAreaError * rim * rim;
  }

  FlatMesh assemble() const {
    std::vector<std::uint32_t> renumbered(positions_.size(), kNoFlat);
    std::vector<glm::dvec3> vertices;
    for (std::size_t v = 0; v < positions_.size(); ++v) {
      if (!outlines_.isKept[v]) continue;
      renumbered[v] = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back(positions_[v]);
    }
    std::vector<Triangle> triangles;
    FlatMesh merged;
    const auto add = [&](const Triangle& t, std::uint32_t flat) {
      triangles.push_back({renumbered[t[0]], renumbered[t[1]], renumbered[t[2]]});
      // Only where a flat is flat to rounding can nothing stick out of it.
      const bool isFlat = flat != kNoFlat && std::ranges::all_of(t, [&](std::uint32_t v) {
                            return isInPlane(positions_[v], flat);
                          });
      merged.flatOf.push_back(isFlat ? flat : kNoFlat);
    };
    std::vector<bool> isAdded(groups_.planes.size(), false);
    for (std::uint32_t t = 0; t < groups_.flatOf.size(); ++t) {
      const std::uint32_t flat = groups_.flatOf[t];
      if (flat == kNoFlat || isPinned_[flat]) {
        add(mesh_.triangles()[t], flat);
      } else if (!isAdded[flat]) {
        isAdded[flat] = true;
        for (const Triangle& c : cut_[flat])
          add(c, flat);
      }
    }
    if (triangles.size() == mesh_.triangles().size() && maxWay_ == 0.0) {
      merged.mesh = mesh_;
      return merged;
    }
    merged.mesh = TriangleMesh(std::move(vertices), std::move(triangles));
    // A point of a flat is that far from its plane, or from the segments at its rim; then vertices moved.
    merged.deviation = heightAbovePlanes() + outlines_.deviation + maxWay_;
    return merged;
  }

  /// How far the mesh's flats are from their planes [m].
  double heightAbovePlanes() const {
    double most = 0.0;
    for (std::uint32_t t = 0; t < groups_.flatOf.size(); ++t) {
      const std::uint32_t flat = groups_.flatOf[t];
      if (flat == kNoFlat) continue;
      for (const std::uint32_t v : mesh_.triangles()[t])
        most = std::max(most, std::abs(groups_.planes[flat].height(mesh_.vertices()[v])));
    }
    return most;
  }

  /// False if the new mesh has defects that the old one does not have; pins the flats at them.
  bool isSound(const FlatMesh& merged) {
    const MeshTopology &before = mesh_.topology(), &after = merged.mesh.topology();
    if (after.nonManifoldEdges <= before.nonManifoldEdges &&
        after.inconsistentEdges <= before.inconsistentEdges && after.openEdges <= before.openEdges) {
      return true;
    }
    const TriangleMesh& mesh = merged.mesh;
    for (std::uint32_t e = 0; e < mesh.edges().size(); ++e) {
      if (mesh.isEdgeConsistent(e)) continue;
      for (const std::uint32_t f : mesh.facesOfEdge(e)) {
        if (merged.flatOf[f] != kNoFlat) isPinned_[merged.flatOf[f]] = true;
      }
    }
    return false;
  }

  const TriangleMesh& mesh_;
  double tolerance_;
  FlatGroups groups_;
  std::vector<bool> isPinned_;  ///< By flat: its triangles stay.
  double inPlane_;              ///< Max distance of a vertex from a plane that it lies in [m].
  std::vector<std::uint32_t> firstTriangle_, triangles_;
  FlatOutlines outlines_;
  std::vector<glm::dvec3> positions_;
  double maxWay_ = 0.0;  ///< Of a vertex [m].
  std::vector<std::vector<std::array<std::uint32_t, 2>>> segmentsOf_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> innerOf_;
  std::vector<std::vector<Triangle>> cut_;
};

}  // namespace

FlatMesh mergeFlats(const TriangleMesh& mesh, double coordinateRounding,
                    const std::function<void(double fraction)>& onProgress) {
  const auto unchanged = [&] { return FlatMesh{mesh, {}, 0.0}; };
  if (mesh.bounds().isEmpty()) return unchanged();
  const double tolerance = flatTolerance(mesh, coordinateRounding);
  if (!(tolerance > 0.0)) return unchanged();
  constexpr double kGrouped = 0.6;
  const auto report = [&](double fraction) {
    if (onProgress) onProgress(kGrouped * fraction);
  };
  FlatGroups groups = findFlats(mesh, tolerance, report);
  if (groups.planes.empty()) return unchanged();
  std::optional<FlatMesh> merged = FlatMerger(mesh, tolerance, std::move(groups)).merge();
  if (onProgress) onProgress(1.0);
  return merged ? std::move(*merged) : unchanged();
}

}  // namespace nearfit
