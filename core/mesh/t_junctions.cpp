#include "core/mesh/t_junctions.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <glm/geometric.hpp>

#include "core/mesh/point_tree.h"

namespace nearfit {
namespace {

/// Max boxes visited before a mesh counts as torn: about a second.
constexpr std::uint64_t kMaxVisits = 50'000'000;
/// Max rounds of dropping edges that do not close, which may open others. Two or three are common.
constexpr int kMaxRounds = 32;

using Run = std::pair<std::uint32_t, std::uint32_t>;  ///< From one vertex to the next.

/// An open edge, directed as in its triangle, and the vertices that lie on it.
struct OpenSide {
  std::uint32_t triangle, from, to, apex;
  std::uint32_t firstPoint = 0, pointCount = 0;  ///< In the edge's direction.
};

class Stitcher {
 public:
  Stitcher(const TriangleMesh& mesh, double reach) : mesh_(mesh), reach_(reach) {}

  /// @param origins  May be null.
  std::vector<Triangle> stitch(std::vector<std::uint32_t>* origins) {
    gatherSides();
    if (!findPoints()) return {};
    for (int round = 0; round < kMaxRounds && dropWhatStaysOpen(); ++round) {
      if (!splitAll()) continue;
      if (origins != nullptr) *origins = std::move(origins_);
      return std::move(triangles_);
    }
    return {};
  }

 private:
  const glm::dvec3& at(std::uint32_t v) const { return mesh_.vertices()[v]; }
  std::span<const std::uint32_t> pointsOn(const OpenSide& side) const {
    return std::span(points_).subspan(side.firstPoint, side.pointCount);
  }

  void gatherSides() {
    for (std::uint32_t e = 0; e < mesh_.edges().size(); ++e) {
      const auto faces = mesh_.facesOfEdge(e);
      if (faces.size() != 1) continue;
      const Triangle& t = mesh_.triangles()[faces[0]];
      const auto& edges = mesh_.edgesOfTriangle(faces[0]);
      const auto k = static_cast<std::size_t>(std::ranges::find(edges, e) - edges.begin());
      sides_.push_back({faces[0], t[k], t[(k + 1) % 3], t[(k + 2) % 3]});
    }
  }

  /// Returns false if there is nothing to split, or if the search takes too long.
  bool findPoints() {
    std::vector<std::uint32_t> rim;
    for (const OpenSide& side : sides_)
      rim.insert(rim.end(), {side.from, side.to});
    std::ranges::sort(rim);
    rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
    PointTree tree(mesh_.vertices(), std::move(rim));
    std::vector<std::uint32_t> candidates;
    for (OpenSide& side : sides_) {
      candidates.clear();
      tree.findNear(at(side.from), at(side.to), reach_, candidates);
      if (tree.visits() > kMaxVisits) return false;
      addPoints(side, candidates);
    }
    return !points_.empty();
  }

  /// Stores the candidates that lie on the side between its ends, in order, unless splitting there would flip
  /// a fragment of the triangle.
  void addPoints(OpenSide& side, std::span<const std::uint32_t> candidates) {
    const glm::dvec3 start = at(side.from), along = at(side.to) - start;
    const double squared = glm::dot(along, along);
    std::vector<std::pair<double, std::uint32_t>> on;
    for (const std::uint32_t v : candidates) {
      if (v == side.from || v == side.to || v == side.apex) continue;
      const glm::dvec3 w = at(v) - start;
      const double share = glm::dot(w, along) / squared;
      if (share > 0.0 && share < 1.0 && glm::length(w - share * along) <= reach_) on.emplace_back(share, v);
    }
    if (on.empty()) return;
    std::ranges::sort(on);
    const glm::dvec3 apex = at(side.apex), normal = glm::cross(along, apex - start);
    glm::dvec3 last = start;
    for (std::size_t i = 0; i <= on.size(); ++i) {
      const glm::dvec3 next = i < on.size() ? at(on[i].second) : at(side.to);
      if (!(glm::dot(glm::cross(next - last, apex - last), normal) > 0.0)) return;
      last = next;
    }
    side.firstPoint = static_cast<std::uint32_t>(points_.size());
    side.pointCount = static_cast<std::uint32_t>(on.size());
    for (const auto& [share, v] : on)
      points_.push_back(v);
  }

  template <class Visit>
  void forEachRun(const OpenSide& side, Visit&& visit) const {
    std::uint32_t last = side.from;
    for (const std::uint32_t v : pointsOn(side))
      visit(Run{std::exchange(last, v), v});
    visit(Run{last, side.to});
  }

  /// Leaves a side whole if any of its segments would stay open. Returns false if no side is left to split.
  bool dropWhatStaysOpen() {
    for (int round = 0; round < kMaxRounds; ++round) {
      countRuns();
      bool isSettled = true, isAny = false;
      for (OpenSide& side : sides_) {
        if (side.pointCount == 0) continue;
        bool isClosed = true;
        forEachRun(side, [&](const Run& run) { isClosed = isClosed && isMatched(run); });
        isAny = isAny || isClosed;
        if (isClosed) continue;
        side.pointCount = 0;
        isSettled = false;
      }
      if (isSettled) return isAny;
    }
    return false;
  }

  static std::uint64_t keyOf(const Run& run) { return std::uint64_t{run.first} << 32 | run.second; }

  void countRuns() {
    runs_.clear();
    for (const OpenSide& side : sides_)
      forEachRun(side, [this](const Run& run) { ++runs_[keyOf(run)]; });
  }

  /// True if the segment is used once in each direction, and its edge has no two faces yet.
  bool isMatched(const Run& run) const {
    const auto forth = runs_.find(keyOf(run)), back = runs_.find(keyOf({run.second, run.first}));
    if (forth == runs_.end() || back == runs_.end() || forth->second != 1 || back->second != 1) return false;
    return facesAt(run) < 2;
  }

  /// Number of faces at the edge between two vertices; 0 if there is no such edge.
  std::uint32_t facesAt(const Run& run) const {
    for (const std::uint32_t e : mesh_.edgesOfVertex(run.first)) {
      const MeshEdge& edge = mesh_.edges()[e];
      if (edge.v0 == run.second || edge.v1 == run.second) return edge.faceCount;
    }
    return 0;
  }

  /// Splits all triangles. Returns false if a side had to stay whole, which may leave others open.
  bool splitAll() {
    triangles_.assign(mesh_.triangles().begin(), mesh_.triangles().end());
    origins_.resize(triangles_.size());
    std::iota(origins_.begin(), origins_.end(), 0U);
    piecesOf_.clear();
    newEdges_.clear();
    bool isWhole = false;
    for (OpenSide& side : sides_) {
      if (side.pointCount == 0 || split(side)) continue;
      side.pointCount = 0;
      isWhole = true;
    }
    return !isWhole;
  }

  /// Splits the fragment with the whole side into a fan. Returns false if a new edge already exists, since
  /// more than two faces would meet there.
  bool split(const OpenSide& side) {
    std::vector<std::uint32_t>& pieces = piecesOf_[side.triangle];
    if (pieces.empty()) pieces.push_back(side.triangle);
    const auto hasSide = [&](std::uint32_t piece) { return apexOver(side, triangles_[piece]).has_value(); };
    const std::uint32_t piece = *std::ranges::find_if(pieces, hasSide);
    const std::uint32_t apex = *apexOver(side, triangles_[piece]);
    for (const std::uint32_t v : pointsOn(side)) {
      if (v == apex || facesAt({v, apex}) > 0 || !newEdges_.insert(keyOf(std::minmax(v, apex))).second)
        return false;
    }
    bool isFirst = true;
    forEachRun(side, [&](const Run& run) {
      const Triangle part{run.first, run.second, apex};
      if (std::exchange(isFirst, false)) {
        triangles_[piece] = part;
        return;
      }
      pieces.push_back(static_cast<std::uint32_t>(triangles_.size()));
      triangles_.push_back(part);
      origins_.push_back(side.triangle);
    });
    return true;
  }

  /// Third corner of the triangle, if it runs along the whole side.
  static std::optional<std::uint32_t> apexOver(const OpenSide& side, const Triangle& t) {
    const auto k = static_cast<std::size_t>(std::ranges::find(t, side.from) - t.begin());
    if (k == 3 || t[(k + 1) % 3] != side.to) return std::nullopt;
    return t[(k + 2) % 3];
  }

  const TriangleMesh& mesh_;
  double reach_;  ///< [m]
  std::vector<OpenSide> sides_;
  std::vector<std::uint32_t> points_;
  std::unordered_map<std::uint64_t, std::uint32_t> runs_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> piecesOf_;
  std::unordered_set<std::uint64_t> newEdges_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> origins_;  ///< By triangle of triangles_.
};

}  // namespace

std::vector<Triangle> stitchTJunctions(const TriangleMesh& mesh, std::vector<std::uint32_t>* origins) {
  if (mesh.topology().openEdges == 0) return {};
  return Stitcher(mesh, kOnEdge * mesh.bounds().diagonal()).stitch(origins);
}

std::vector<Triangle> stitchTJunctions(const TriangleMesh& mesh, double reach,
                                       std::vector<std::uint32_t>& originOf) {
  originOf.clear();
  if (mesh.topology().openEdges == 0) return {};
  return Stitcher(mesh, reach).stitch(&originOf);
}

}  // namespace nearfit
