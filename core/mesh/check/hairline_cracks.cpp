#include "core/mesh/check/hairline_cracks.h"

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <utility>

#include <glm/geometric.hpp>

#include "core/math/nearest_on_segment.h"
#include "core/mesh/point_tree.h"

namespace nearfit {
namespace {

/// Max boxes visited and candidates looked at: some seconds.
constexpr std::uint64_t kMaxCrackWork = 100'000'000;
constexpr std::uint32_t kEdgesPerReport = 1024;
constexpr std::uint32_t kNoVertexBeside = std::numeric_limits<std::uint32_t>::max();

class CrackFinder {
 public:
  CrackFinder(const TriangleMesh& mesh, double tolerance) : mesh_(mesh), tolerance_(tolerance) {
    for (std::uint32_t e = 0; e < mesh.edges().size(); ++e) {
      const auto faces = mesh.facesOfEdge(e);
      if (faces.size() != 1) continue;
      const auto& edges = mesh.edgesOfTriangle(faces[0]);
      const auto k = static_cast<std::size_t>(std::ranges::find(edges, e) - edges.begin());
      const Triangle& t = mesh.triangles()[faces[0]];
      sides_.push_back({e, t[k], t[(k + 1) % 3]});
    }
    for (const Side& side : sides_) {
      const glm::dvec3 along = at(side.to) - at(side.from);
      const double length = glm::length(along);
      // References stay valid while the map grows.
      RimVertex &from = rimAt_[side.from], &to = rimAt_[side.to];
      from.add(side.to);
      to.add(side.from);
      if (!(length > 0.0)) continue;
      from.direction += along / length;
      to.direction += along / length;
    }
  }

  HairlineCracks find(const std::function<void(double)>& report) {
    HairlineCracks result;
    PointTree tree(mesh_.vertices(), rim());
    std::vector<std::uint32_t> candidates;
    std::uint64_t looked = 0;
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      if (i % kEdgesPerReport == 0) report(static_cast<double>(i) / static_cast<double>(sides_.size()));
      candidates.clear();
      tree.findNear(at(sides_[i].from), at(sides_[i].to), tolerance_, candidates);
      looked += candidates.size();
      if (tree.visits() + looked > kMaxCrackWork) {
        result.isComplete = false;
        break;
      }
      std::ranges::sort(candidates);
      for (const std::uint32_t vertex : candidates)
        judge(sides_[i], vertex, result);
    }
    return result;
  }

 private:
  struct Side {
    std::uint32_t edge, from, to;
  };
  /// A vertex of open edges.
  struct RimVertex {
    glm::dvec3 direction{0.0};  ///< Sum of the unit directions of its open edges.
    /// Ends of the first two of them.
    std::array<std::uint32_t, 2> beside{kNoVertexBeside, kNoVertexBeside};

    void add(std::uint32_t vertex) noexcept {
      if (beside[0] == kNoVertexBeside)
        beside[0] = vertex;
      else if (beside[1] == kNoVertexBeside)
        beside[1] = vertex;
    }
  };

  const glm::dvec3& at(std::uint32_t v) const { return mesh_.vertices()[v]; }

  std::vector<std::uint32_t> rim() const {
    std::vector<std::uint32_t> vertices;
    for (const Side& side : sides_)
      vertices.insert(vertices.end(), {side.from, side.to});
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }

  void judge(const Side& side, std::uint32_t vertex, HairlineCracks& result) const {
    if (vertex == side.from || vertex == side.to) return;
    const double distance =
        glm::distance(at(vertex), nearestOnSegment(at(side.from), at(side.to), at(vertex)));
    if (distance > tolerance_) return;
    // A border of short edges that goes on past the end of this one is no other border. The two sides of a crack run
    // against each other.
    const bool isSameWay = glm::dot(rimAt_.at(vertex).direction, at(side.to) - at(side.from)) > 0.0;
    if (isSameWay && isNextTo(side, vertex)) return;
    result.pairs.push_back({side.edge, vertex, distance});
  }

  /// True if the border leads from an end of the side to the vertex without leaving the place.
  bool isNextTo(const Side& side, std::uint32_t vertex) const {
    return leadsTo(side.from, side.to, vertex) || leadsTo(side.to, side.from, vertex);
  }

  /// Goes along the border from `last` over `start`.
  bool leadsTo(std::uint32_t last, std::uint32_t start, std::uint32_t vertex) const {
    // A border that takes more edges to come back within the tolerance is coiled up: nothing to feel as a border.
    constexpr int kMaxSteps = 32;
    std::uint32_t present = start;
    for (int step = 0; step < kMaxSteps; ++step) {
      const auto& beside = rimAt_.at(present).beside;
      const std::uint32_t next = beside[0] == last ? beside[1] : beside[0];
      if (next == vertex) return true;
      if (next == kNoVertexBeside || glm::distance(at(next), at(start)) > 2.0 * tolerance_) return false;
      last = std::exchange(present, next);
    }
    return false;
  }

  const TriangleMesh& mesh_;
  const double tolerance_;
  std::vector<Side> sides_;
  std::unordered_map<std::uint32_t, RimVertex> rimAt_;
};

}  // namespace

HairlineCracks findHairlineCracks(const TriangleMesh& mesh, double tolerance,
                                  const ProgressCallback& progress) {
  if (mesh.topology().openEdges == 0) return {};
  return CrackFinder(mesh, tolerance).find(stageOf(progress, 0.0, 1.0));
}

}  // namespace nearfit
