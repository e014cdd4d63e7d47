#include "core/mesh/check/border_loops.h"

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <utility>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

constexpr std::uint32_t kNoBorderSide = std::numeric_limits<std::uint32_t>::max();

/// An open edge as its triangle runs along it.
struct BorderSide {
  std::uint32_t triangle, corner;  ///< From this corner of the triangle to the next.
  std::uint32_t from, to;
};

class LoopTracer {
 public:
  explicit LoopTracer(const TriangleMesh& mesh) : mesh_(mesh) {
    for (std::uint32_t e = 0; e < mesh.edges().size(); ++e) {
      const auto faces = mesh.facesOfEdge(e);
      if (faces.size() != 1) continue;
      const auto& edges = mesh.edgesOfTriangle(faces[0]);
      const auto k = static_cast<std::uint32_t>(std::ranges::find(edges, e) - edges.begin());
      const Triangle& t = mesh.triangles()[faces[0]];
      sideOfEdge_.emplace(e, static_cast<std::uint32_t>(sides_.size()));
      sides_.push_back({faces[0], k, t[k], t[(k + 1) % 3]});
    }
    linkSides();
  }

  std::vector<BorderLoop> trace() {
    std::vector<bool> isUsed(sides_.size(), false);
    const auto follow = [&](std::uint32_t start) {
      std::vector<std::uint32_t> chain;
      for (std::uint32_t side = start; side != kNoBorderSide && !isUsed[side]; side = next_[side]) {
        isUsed[side] = true;
        chain.push_back(side);
      }
      cut(chain);
    };
    // Ways with an end begin where nothing leads to.
    for (std::uint32_t side = 0; side < sides_.size(); ++side) {
      if (!hasBefore_[side]) follow(side);
    }
    for (std::uint32_t side = 0; side < sides_.size(); ++side) {
      if (!isUsed[side]) follow(side);
    }
    return std::move(loops_);
  }

 private:
  /// Gives each side the one after it, and no side to two.
  void linkSides() {
    next_.assign(sides_.size(), kNoBorderSide);
    hasBefore_.assign(sides_.size(), false);
    for (std::uint32_t side = 0; side < sides_.size(); ++side) {
      const std::uint32_t after = sideAfter(side);
      if (after == kNoBorderSide || hasBefore_[after]) continue;
      next_[side] = after;
      hasBefore_[after] = true;
    }
    // Where the fan is torn, any side that begins there and is free.
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> freeAt;
    for (std::uint32_t side = 0; side < sides_.size(); ++side) {
      if (!hasBefore_[side]) freeAt[sides_[side].from].push_back(side);
    }
    for (std::uint32_t side = 0; side < sides_.size(); ++side) {
      if (next_[side] != kNoBorderSide) continue;
      const auto found = freeAt.find(sides_[side].to);
      if (found == freeAt.end() || found->second.empty()) continue;
      next_[side] = found->second.back();
      found->second.pop_back();
      hasBefore_[next_[side]] = true;
    }
  }

  /// The side that follows on the same sheet: turns about the end of this one, from triangle to triangle.
  std::uint32_t sideAfter(std::uint32_t side) const {
    const std::uint32_t pivot = sides_[side].to;
    std::uint32_t triangle = sides_[side].triangle;
    // A fan has no more triangles than edges meet in its middle.
    for (std::size_t left = mesh_.edgesOfVertex(pivot).size(); left > 0; --left) {
      const Triangle& t = mesh_.triangles()[triangle];
      const auto k = static_cast<std::uint32_t>(std::ranges::find(t, pivot) - t.begin());
      if (k == 3) return kNoBorderSide;
      const std::uint32_t edge = mesh_.edgesOfTriangle(triangle)[k];
      const auto faces = mesh_.facesOfEdge(edge);
      if (faces.size() == 1) return sideOfEdge_.at(edge);
      if (!mesh_.isEdgeConsistent(edge)) return kNoBorderSide;
      triangle = faces[0] == triangle ? faces[1] : faces[0];
    }
    return kNoBorderSide;
  }

  /// Cuts a way into loops that pass each vertex once, and what is left.
  void cut(const std::vector<std::uint32_t>& chain) {
    std::vector<std::uint32_t> open;                         // Vertices of the way so far.
    std::unordered_map<std::uint32_t, std::size_t> placeOf;  // Its place, for each of them.
    const auto visit = [&](std::uint32_t vertex) {
      const auto [place, isNew] = placeOf.try_emplace(vertex, open.size());
      if (isNew) {
        open.push_back(vertex);
        return;
      }
      const auto begin = open.begin() + static_cast<std::ptrdiff_t>(place->second);
      add({begin, open.end()}, true);
      for (auto it = begin + 1; it != open.end(); ++it)
        placeOf.erase(*it);
      open.erase(begin + 1, open.end());
    };
    visit(sides_[chain.front()].from);
    for (const std::uint32_t side : chain)
      visit(sides_[side].to);
    if (open.size() > 1) add(std::move(open), false);
  }

  void add(std::vector<std::uint32_t> vertices, bool isClosed) {
    BorderLoop loop{std::move(vertices), isClosed, 0.0};
    for (std::size_t i = 0; i < loop.edgeCount(); ++i) {
      const std::uint32_t from = loop.vertices[i], to = loop.vertices[(i + 1) % loop.vertices.size()];
      loop.length += glm::distance(mesh_.vertices()[from], mesh_.vertices()[to]);
    }
    loops_.push_back(std::move(loop));
  }

  const TriangleMesh& mesh_;
  std::vector<BorderSide> sides_;
  std::unordered_map<std::uint32_t, std::uint32_t> sideOfEdge_;
  std::vector<std::uint32_t> next_;
  std::vector<bool> hasBefore_;
  std::vector<BorderLoop> loops_;
};

}  // namespace

std::vector<BorderLoop> borderLoopsOf(const TriangleMesh& mesh) {
  if (mesh.topology().openEdges == 0) return {};
  return LoopTracer(mesh).trace();
}

}  // namespace nearfit
