#include "core/mesh/flat_outlines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "core/math/nearest_on_segment.h"

namespace nearfit {
namespace {

using Flats = std::array<std::uint32_t, OutlineSegment::kMaxTriangles>;
constexpr Flats kNone{kNoFlat, kNoFlat, kNoFlat, kNoFlat};

/// Max depth of halving a chain. Beyond it all vertices are kept, so that no chain takes quadratic time.
constexpr int kMaxDepth = 64;
/// Fewest corners of a closed outline.
constexpr std::size_t kLeastCorners = 3;

double distanceFromSegment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  return glm::distance(p, nearestOnSegment(a, b, p));
}

class OutlineFinder {
 public:
  OutlineFinder(const TriangleMesh& mesh, const FlatGroups& groups, double tolerance,
                const std::vector<bool>& isPinned)
      : mesh_(mesh),
        groups_(groups),
        tolerance_(tolerance),
        isPinned_(isPinned),
        isWalked_(mesh.edges().size(), false) {}

  FlatOutlines find() {
    const std::size_t count = mesh_.vertices().size();
    out_.isKept.assign(count, false);
    isInChain_.assign(count, false);
    for (std::uint32_t v = 0; v < count; ++v)
      classify(v);
    for (std::uint32_t v = 0; v < count; ++v) {
      if (out_.isKept[v]) walkFrom(v);
    }
    // What is left are closed chains without a kept vertex.
    for (std::uint32_t v = 0; v < count; ++v) {
      if (isInChain_[v] && !out_.isKept[v]) walkRound(v);
    }
    return std::move(out_);
  }

 private:
  /// Flats of the triangles at an edge, of which there are few enough.
  Flats flatsAt(std::uint32_t edge) const {
    Flats flats = kNone;
    std::size_t count = 0;
    for (const std::uint32_t f : mesh_.facesOfEdge(edge))
      flats[count++] = groups_.flatOf[f];
    std::ranges::sort(flats);
    return flats;
  }
  bool isOutline(std::uint32_t edge) const {
    if (!mesh_.isEdgeConsistent(edge)) return true;
    const auto faces = mesh_.facesOfEdge(edge);
    return groups_.flatOf[faces[0]] != groups_.flatOf[faces[1]] || groups_.flatOf[faces[0]] == kNoFlat;
  }

  /// Adds a flat to those around a vertex; false if there are too many.
  static bool add(std::uint32_t flat, Flats& around) {
    for (std::uint32_t& at : around) {
      if (at == flat) return true;
      if (at != kNoFlat) continue;
      at = flat;
      return true;
    }
    return false;
  }

  /// Decides whether a vertex is kept, in a chain, or neither. Vertices of no triangle are dropped.
  void classify(std::uint32_t v) {
    if (mesh_.edgesOfVertex(v).empty()) return;
    std::array<std::uint32_t, 2> outline{};
    std::size_t outlines = 0;
    Flats around = kNone;
    bool isKept = false;
    for (const std::uint32_t e : mesh_.edgesOfVertex(v)) {
      if (isOutline(e)) {
        if (outlines < outline.size()) outline[outlines] = e;
        ++outlines;
        isKept = isKept || mesh_.facesOfEdge(e).size() > OutlineSegment::kMaxTriangles;
      }
      for (const std::uint32_t f : mesh_.facesOfEdge(e)) {
        const std::uint32_t flat = groups_.flatOf[f];
        isKept = isKept || flat == kNoFlat || isPinned_[flat] || !add(flat, around);
      }
    }
    std::ranges::sort(around);
    if (!isKept && outlines == 0 && around[1] == kNoFlat) return;
    const bool isInChain = !isKept && outlines == outline.size() && flatsAt(outline[0]) == around &&
                           flatsAt(outline[1]) == around;
    isInChain_[v] = isInChain;
    out_.isKept[v] = !isInChain;
    if (outlines > 0) return;
    for (const std::uint32_t flat : around) {
      if (flat != kNoFlat) out_.inner.push_back({v, flat});
    }
  }

  /// As flatsAt(), or no flats if too many triangles meet at the edge. The outlines of those flats then have a gap,
  /// and cutting them fails.
  Flats sidesOf(std::uint32_t edge) const {
    return mesh_.facesOfEdge(edge).size() <= OutlineSegment::kMaxTriangles ? flatsAt(edge) : kNone;
  }

  std::uint32_t otherEnd(std::uint32_t edge, std::uint32_t v) const {
    const MeshEdge& e = mesh_.edges()[edge];
    return e.v0 == v ? e.v1 : e.v0;
  }
  /// The other outline edge at a vertex in a chain.
  std::uint32_t nextEdge(std::uint32_t v, std::uint32_t edge) const {
    for (const std::uint32_t e : mesh_.edgesOfVertex(v)) {
      if (e != edge && isOutline(e)) return e;
    }
    return edge;
  }

  void walkFrom(std::uint32_t start) {
    for (const std::uint32_t first : mesh_.edgesOfVertex(start)) {
      if (isWalked_[first] || !isOutline(first)) continue;
      chain_.assign(1, start);
      follow(first, start);
      const Flats flats = sidesOf(first);
      // A chain may come back to where it began.
      if (chain_.back() == start) {
        keepRound(flats);
      } else {
        simplify(0, chain_.size() - 1, flats, 0);
      }
    }
  }

  /// Appends the vertices of a chain up to the next kept vertex, or to where it began.
  void follow(std::uint32_t edge, std::uint32_t from) {
    const std::uint32_t start = from;
    std::uint32_t v = from;
    do {
      isWalked_[edge] = true;
      v = otherEnd(edge, v);
      chain_.push_back(v);
      if (out_.isKept[v] || v == start) return;
      edge = nextEdge(v, edge);
    } while (!isWalked_[edge]);
  }

  void walkRound(std::uint32_t v) {
    std::uint32_t first = kNoFlat;
    for (const std::uint32_t e : mesh_.edgesOfVertex(v)) {
      if (isOutline(e) && !isWalked_[e]) first = e;
    }
    if (first == kNoFlat) return;
    chain_.assign(1, v);
    follow(first, v);
    keepRound(sidesOf(first));
  }

  /// Simplifies a closed chain, whose first vertex stands at both ends: between it, the vertex farthest from it
  /// and the vertex farthest from the line through both.
  void keepRound(const Flats& flats) {
    const auto farthest = [&](auto distance) {
      std::size_t best = 1;
      for (std::size_t i = 1; i + 1 < chain_.size(); ++i) {
        if (distance(at(i)) > distance(at(best))) best = i;
      }
      return best;
    };
    if (chain_.size() <= kLeastCorners + 1) {
      for (std::size_t i = 0; i + 1 < chain_.size(); ++i)
        addSegment(i, i + 1, flats);
      return;
    }
    const glm::dvec3 a = at(0);
    const std::size_t far = farthest([&](const glm::dvec3& p) { return glm::distance(p, a); });
    const glm::dvec3 b = at(far);
    std::size_t aside = farthest([&](const glm::dvec3& p) { return distanceFromSegment(p, a, b); });
    if (aside == far) aside = far > 1 ? far - 1 : far + 1;
    const auto [first, second] = std::minmax(far, aside);
    simplify(0, first, flats, 0);
    simplify(first, second, flats, 0);
    simplify(second, chain_.size() - 1, flats, 0);
  }

  const glm::dvec3& at(std::size_t i) const { return mesh_.vertices()[chain_[i]]; }

  /// Keeps the vertices from `first` to `last` that are off the segments between kept ones (Douglas and
  /// Peucker), and adds those segments.
  void simplify(std::size_t first, std::size_t last, const Flats& flats, int depth) {
    std::size_t worst = first;
    double most = 0.0;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double off = distanceFromSegment(at(i), at(first), at(last));
      if (off > most) {
        most = off;
        worst = i;
      }
    }
    if (most <= tolerance_) {
      out_.deviation = std::max(out_.deviation, most);
      addSegment(first, last, flats);
    } else if (depth == kMaxDepth) {
      for (std::size_t i = first; i < last; ++i)
        addSegment(i, i + 1, flats);
    } else {
      simplify(first, worst, flats, depth + 1);
      simplify(worst, last, flats, depth + 1);
    }
  }

  void addSegment(std::size_t from, std::size_t to, const Flats& flats) {
    out_.isKept[chain_[from]] = out_.isKept[chain_[to]] = true;
    out_.segments.push_back({{chain_[from], chain_[to]}, flats});
  }

  const TriangleMesh& mesh_;
  const FlatGroups& groups_;
  double tolerance_;
  const std::vector<bool>& isPinned_;
  std::vector<bool> isWalked_;  ///< By edge.
  std::vector<bool> isInChain_;
  std::vector<std::uint32_t> chain_;
  FlatOutlines out_;
};

}  // namespace

FlatOutlines findOutlines(const TriangleMesh& mesh, const FlatGroups& groups, double tolerance,
                          const std::vector<bool>& isPinned) {
  return OutlineFinder(mesh, groups, tolerance, isPinned).find();
}

}  // namespace nearfit
