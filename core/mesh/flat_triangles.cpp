#include "core/mesh/flat_triangles.h"

#include <algorithm>
#include <array>
#include <limits>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

/// Side of a triangle, as 3 * triangle + corner: from that corner to the next.
using Side = std::uint32_t;
constexpr Side kNoSide = std::numeric_limits<Side>::max();

Side nextSide(Side s) {
  return s % 3 == 2 ? s - 2 : s + 1;
}
Side previousSide(Side s) {
  return s % 3 == 0 ? s + 2 : s - 1;
}

glm::dvec3 doubleArea(std::span<const glm::dvec3> vertices, const Triangle& t) {
  return glm::cross(vertices[t[1]] - vertices[t[0]], vertices[t[2]] - vertices[t[0]]);
}

class Swapper {
 public:
  Swapper(std::span<const glm::dvec3> vertices, std::vector<Triangle>& triangles, double tolerance,
          std::vector<std::uint32_t>* sources)
      : vertices_(vertices), triangles_(triangles), tolerance_(tolerance), sources_(sources) {
    matchSides();
  }

  /// Swaps what can be swapped. A swap may make a flat neighbour swappable. Each swap makes the
  /// thinner triangle fatter, or an edge shorter without making any thinner. The limit stops cycles in
  /// badly damaged meshes.
  std::uint64_t run(std::vector<std::uint32_t> flat) {
    constexpr std::uint64_t kMaxSwapsEach = 20;
    const std::uint64_t mostSwaps = kMaxSwapsEach * flat.size();
    std::uint64_t swapped = 0;
    std::ranges::reverse(flat);
    while (!flat.empty() && swapped < mostSwaps) {
      const std::uint32_t t = flat.back();
      flat.pop_back();
      if (!isFlat(triangles_[t])) continue;
      const std::uint32_t other = trySwap(t);
      if (other == kNoSide) continue;
      ++swapped;
      for (const std::uint32_t changed : {t, other}) {
        if (isFlat(triangles_[changed])) flat.push_back(changed);
        for (Side s = 3 * changed; s < 3 * changed + 3; ++s) {
          if (twin_[s] != kNoSide && isFlat(triangles_[twin_[s] / 3])) flat.push_back(twin_[s] / 3);
        }
      }
    }
    return swapped;
  }

 private:
  std::uint32_t origin(Side s) const { return triangles_[s / 3][s % 3]; }
  std::uint32_t opposite(Side s) const { return origin(previousSide(s)); }
  bool isFlat(const Triangle& t) const { return leastHeight(vertices_, t) <= tolerance_; }

  /// Pairs the sides of ordinary edges: two faces that run along the edge in opposite directions.
  void matchSides() {
    struct Entry {
      std::uint64_t edge;
      Side side;
    };
    std::vector<Entry> entries;
    entries.reserve(3 * triangles_.size());
    for (Side s = 0; s < 3 * triangles_.size(); ++s) {
      const std::uint64_t a = origin(s), b = origin(nextSide(s));
      entries.push_back({std::min(a, b) << 32 | std::max(a, b), s});
    }
    std::ranges::sort(entries, [](const Entry& a, const Entry& b) {
      return a.edge != b.edge ? a.edge < b.edge : a.side < b.side;
    });
    twin_.assign(3 * triangles_.size(), kNoSide);
    for (std::size_t i = 0, end = 0; i < entries.size(); i = end) {
      while (end < entries.size() && entries[end].edge == entries[i].edge)
        ++end;
      if (end - i != 2 || origin(entries[i].side) == origin(entries[i + 1].side)) continue;
      join(entries[i].side, entries[i + 1].side);
    }
  }
  void join(Side a, Side b) {
    if (a != kNoSide) twin_[a] = b;
    if (b != kNoSide) twin_[b] = a;
  }

  Side longestSide(std::uint32_t triangle) const {
    Side longest = 3 * triangle;
    double length = -1.0;
    for (Side s = 3 * triangle; s < 3 * triangle + 3; ++s) {
      const double l = glm::distance(vertices_[origin(s)], vertices_[origin(nextSide(s))]);
      if (l > length) {
        length = l;
        longest = s;
      }
    }
    return longest;
  }

  /// True if an edge joins the origin of `start` to `vertex`, searching the connected fan of faces. Returns
  /// true for very large fans, which bounds the time for malicious files.
  bool hasNeighbour(Side start, std::uint32_t vertex) const {
    constexpr int kMaxFaces = 1000;
    int faces = 0;
    Side s = start;
    do {
      if (origin(nextSide(s)) == vertex || opposite(s) == vertex || ++faces > kMaxFaces) return true;
      s = twin_[previousSide(s)];
    } while (s != kNoSide && s != start);
    if (s == start) return false;
    for (s = twin_[start]; s != kNoSide; s = twin_[nextSide(s)]) {
      if (opposite(nextSide(s)) == vertex || opposite(s) == vertex || ++faces > kMaxFaces) return true;
    }
    return false;
  }

  /// True if two new triangles are better than `flat` and the face `behind` its longest side: fatter, and
  /// facing like that face. If that face is flat too and shares the longest side, a shorter new edge is
  /// enough, since the triangles then lie between other faces.
  bool isWorthSwapping(const Triangle& flat, Side behind, const Triangle& first,
                       const Triangle& second) const {
    const Triangle& face = triangles_[behind / 3];
    const glm::dvec3 normal = doubleArea(vertices_, face);
    const double before = std::min(leastHeight(vertices_, flat), leastHeight(vertices_, face));
    const double after = std::min(leastHeight(vertices_, first), leastHeight(vertices_, second));
    if (after > before && glm::dot(normal, doubleArea(vertices_, first)) > 0.0 &&
        glm::dot(normal, doubleArea(vertices_, second)) > 0.0) {
      return true;
    }
    return isFlat(face) && after >= before && longestSide(behind / 3) == behind &&
           isShorter(first, second, behind);
  }
  /// True if the edge shared by the new triangles abd and bcd is shorter than `side`.
  bool isShorter(const Triangle& first, const Triangle& second, Side side) const {
    return glm::distance(vertices_[second[0]], vertices_[first[2]]) <
           glm::distance(vertices_[origin(side)], vertices_[origin(nextSide(side))]);
  }

  /// Replaces a flat triangle abc with longest side c-a, and the face acd behind it, by abd and bcd. Returns
  /// that face, or kNoSide if no swap is possible.
  std::uint32_t trySwap(std::uint32_t triangle) {
    const Side ca = longestSide(triangle), ac = twin_[ca];
    if (ac == kNoSide) return kNoSide;
    const std::uint32_t a = origin(ac), b = opposite(ca), c = origin(ca), d = opposite(ac);
    const std::uint32_t other = ac / 3;
    if (b == d || !isWorthSwapping(triangles_[triangle], ac, {a, b, d}, {b, c, d}) ||
        hasNeighbour(previousSide(ca), d)) {
      return kNoSide;
    }
    const std::array outer{twin_[nextSide(ca)], twin_[previousSide(ca)], twin_[nextSide(ac)],
                           twin_[previousSide(ac)]};
    const auto isInner = [&](Side s) { return s != kNoSide && (s / 3 == triangle || s / 3 == other); };
    if (std::ranges::any_of(outer, isInner)) return kNoSide;
    triangles_[triangle] = {a, b, d};
    triangles_[other] = {b, c, d};
    if (sources_ != nullptr) (*sources_)[triangle] = (*sources_)[other];
    join(3 * triangle, outer[0]);
    join(3 * triangle + 1, 3 * other + 2);
    join(3 * triangle + 2, outer[3]);
    join(3 * other, outer[1]);
    join(3 * other + 1, outer[2]);
    return other;
  }

  std::span<const glm::dvec3> vertices_;
  std::vector<Triangle>& triangles_;
  double tolerance_;
  std::vector<std::uint32_t>* sources_;  ///< By triangle; may be null.
  std::vector<Side> twin_;               ///< By side: the opposite side of its edge, or kNoSide.
};

}  // namespace

double leastHeight(std::span<const glm::dvec3> vertices, const Triangle& t) {
  const glm::dvec3 a = vertices[t[0]], b = vertices[t[1]], c = vertices[t[2]];
  const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
  return longest > 0.0 ? glm::length(glm::cross(b - a, c - a)) / longest : 0.0;
}

std::uint64_t swapFlatTriangles(std::span<const glm::dvec3> vertices, std::vector<Triangle>& triangles,
                                double tolerance, std::vector<std::uint32_t>* sources) {
  std::vector<std::uint32_t> flat;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (leastHeight(vertices, triangles[t]) <= tolerance) flat.push_back(t);
  }
  return flat.empty() ? 0 : Swapper(vertices, triangles, tolerance, sources).run(std::move(flat));
}

}  // namespace nearfit
