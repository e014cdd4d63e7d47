#include "tests/support/region_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace nearfit::test {
namespace {

using Feature = OracleBody::Feature;
using Points = std::vector<glm::dvec3>;

/// The definition's: see kFlatTolerance.
constexpr double kParallel = 1e-6;

double cross2(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

struct Piece {
  int dimension;
  Points points;  ///< On the scene's side; a hull.
  glm::dvec3 direction;
  double least;
};

/// Coordinates in a plane.
struct Frame {
  glm::dvec3 origin, n, x, y;
  Frame(const glm::dvec3& o, const glm::dvec3& normal) : origin(o), n(normal) {
    x = glm::normalize(glm::cross(n, std::abs(n.z) < 0.7 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
    y = glm::cross(n, x);
  }
  glm::dvec2 flat(const glm::dvec3& p) const { return {glm::dot(p - origin, x), glm::dot(p - origin, y)}; }
  glm::dvec3 solid(const glm::dvec2& p) const { return origin + p.x * x + p.y * y; }
};

std::vector<glm::dvec2> hull(std::vector<glm::dvec2> points) {
  std::sort(points.begin(), points.end(),
            [](auto& a, auto& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<glm::dvec2> out;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = out.size();
    for (const glm::dvec2& p : points) {
      while (out.size() >= base + 2 && cross2(out.back() - out[out.size() - 2], p - out.back()) <= 0.0)
        out.pop_back();
      out.push_back(p);
    }
    if (!out.empty()) out.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return out;
}

bool isInside(const glm::dvec2& p, const std::vector<glm::dvec2>& triangle) {
  const double whole = cross2(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    if (cross2(triangle[(k + 1) % 3] - triangle[k], p - triangle[k]) * whole < 0.0) return false;
  }
  return true;
}

/// Corners of what two convex figures (triangles, or a segment and a triangle) have in common.
std::vector<glm::dvec2> common(const std::vector<glm::dvec2>& a, const std::vector<glm::dvec2>& b) {
  std::vector<glm::dvec2> out;
  const auto addInside = [&out](const auto& points, const auto& triangle) {
    if (triangle.size() < 3) return;
    std::copy_if(points.begin(), points.end(), std::back_inserter(out),
                 [&](const glm::dvec2& p) { return isInside(p, triangle); });
  };
  addInside(a, b);
  addInside(b, a);
  for (std::size_t i = 0; i < (a.size() == 2 ? 1 : a.size()); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      const glm::dvec2 p = a[i], e = a[(i + 1) % a.size()] - p, q = b[j], f = b[(j + 1) % b.size()] - q;
      const double c = cross2(e, f);
      const double s = cross2(q - p, f) / c, t = cross2(q - p, e) / c;
      if (c != 0.0 && s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) out.push_back(p + s * e);
    }
  }
  return out;
}

/// Least distance over a piece, from its corners: the height of the other body over the scene's points.
template <class Height>
double leastOf(const Points& points, const Height& height) {
  double least = std::numeric_limits<double>::infinity();
  for (const glm::dvec3& p : points)
    least = std::min(least, height(p));
  return least;
}

glm::dvec3 mean(const Points& points) {
  return std::accumulate(points.begin(), points.end(), glm::dvec3(0.0)) / static_cast<double>(points.size());
}

/// Out of an edge's side, and across no face of it.
bool faces(const Feature& edge, const glm::dvec3& d) {
  constexpr double kSlack = 1e-10;
  return (edge.outward == glm::dvec3(0.0) || glm::dot(d, edge.outward) > 0.0) &&
         std::all_of(edge.tangents.begin(), edge.tangents.end(),
                     [&](const glm::dvec3& t) { return glm::dot(d, t) <= kSlack; });
}

void addFacePiece(const Feature& face, const Feature& other, bool faceIsScene, double size,
                  std::vector<Piece>& pieces) {
  const glm::dvec3 n = face.outward;
  const Frame frame(face.corners[0], n);
  const auto flatten = [&](const Points& points) {
    std::vector<glm::dvec2> out;
    for (const glm::dvec3& p : points)
      out.push_back(frame.flat(p));
    return out;
  };
  std::vector<glm::dvec2> corners = common(flatten(other.corners), flatten(face.corners));
  const bool isEdge = other.kind == 'e';
  if (!isEdge) corners = hull(corners);
  if (corners.size() < (isEdge ? 2U : 3U)) return;
  if (isEdge) {
    const auto [first, last] = std::minmax_element(
        corners.begin(), corners.end(), [](auto& a, auto& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    corners = {*first, *last};
    if (glm::distance(corners[0], corners[1]) < 1e-11 * size) return;
  }
  // The other feature's own height over the plane: a line's along the edge, a plane's over the face.
  const auto height = [&](const glm::dvec3& p) {
    if (isEdge) {
      const glm::dvec3 e = other.corners[1] - other.corners[0];
      const double s = glm::dot(p - other.corners[0], e) / glm::dot(e, e);
      return glm::dot(other.corners[0] + s * e - p, n);
    }
    return glm::dot(other.corners[0] - p, other.outward) / glm::dot(n, other.outward);
  };
  Points onFace, onOther;
  for (const glm::dvec2& c : corners) {
    onFace.push_back(frame.solid(c));
    onOther.push_back(onFace.back() + height(onFace.back()) * n);
  }
  if (!(height(mean(onFace)) > 0.0)) return;
  pieces.push_back(
      {isEdge ? 1 : 2, faceIsScene ? onFace : onOther, faceIsScene ? n : -n, leastOf(onFace, height)});
}

void addEdgePiece(const Feature& a, const Feature& b, double size, std::vector<Piece>& pieces) {
  const glm::dvec3 u = glm::normalize(a.corners[1] - a.corners[0]);
  const double s0 = glm::dot(b.corners[0] - a.corners[0], u), s1 = glm::dot(b.corners[1] - a.corners[0], u);
  const double from = std::max(0.0, std::min(s0, s1)),
               to = std::min(glm::distance(a.corners[0], a.corners[1]), std::max(s0, s1));
  if (to - from < 1e-11 * size) return;
  const auto way = [&](double s) {
    return b.corners[0] + (b.corners[1] - b.corners[0]) * ((s - s0) / (s1 - s0)) - (a.corners[0] + s * u);
  };
  const glm::dvec3 middle = way(0.5 * (from + to));
  const double distance = glm::length(middle);
  if (!(distance > 0.0) || !faces(a, middle / distance) || !faces(b, -middle / distance)) return;
  pieces.push_back({1,
                    {a.corners[0] + from * u, a.corners[0] + to * u},
                    middle / distance,
                    std::min({glm::length(way(from)), distance, glm::length(way(to))})});
}

double pointPieceDistance(const glm::dvec3& p, const Points& piece, const glm::dvec3& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  bool left = piece.size() > 2, right = left;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    const glm::dvec3 a = piece[i], e = piece[(i + 1) % piece.size()] - a;
    const double s = std::clamp(glm::dot(p - a, e) / glm::dot(e, e), 0.0, 1.0);
    nearest = std::min(nearest, glm::distance(p, a + s * e));
    const double turn = glm::dot(glm::cross(e, p - a), direction);
    left = left && turn >= 0.0;
    right = right && turn <= 0.0;
  }
  return left || right ? std::min(nearest, std::abs(glm::dot(p - piece[0], direction))) : nearest;
}

/// At one distance and in one plane, all but: they touch where a corner of one is on the other, or sides
/// cross.
bool touches(const Piece& a, const Piece& b, double tolerance) {
  if (glm::distance(a.direction, b.direction) > 1e-4 || std::abs(a.least - b.least) > 1e-5) return false;
  const auto reaches = [&](const Piece& from, const Piece& to) {
    return std::any_of(from.points.begin(), from.points.end(), [&](const glm::dvec3& p) {
      return pointPieceDistance(p, to.points, to.direction) <= tolerance;
    });
  };
  if (reaches(a, b) || reaches(b, a)) return true;
  const Frame frame(a.points[0], a.direction);
  if (std::abs(glm::dot(b.points[0] - a.points[0], a.direction)) > tolerance) return false;
  std::vector<glm::dvec2> fa, fb;
  for (const glm::dvec3& p : a.points)
    fa.push_back(frame.flat(p));
  for (const glm::dvec3& p : b.points)
    fb.push_back(frame.flat(p));
  for (std::size_t i = 0; i < fa.size(); ++i) {
    for (std::size_t j = 0; j < fb.size(); ++j) {
      const glm::dvec2 e = fa[(i + 1) % fa.size()] - fa[i], f = fb[(j + 1) % fb.size()] - fb[j];
      const double c = cross2(e, f), s = cross2(fb[j] - fa[i], f) / c, t = cross2(fb[j] - fa[i], e) / c;
      if (c != 0.0 && s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) return true;
    }
  }
  return false;
}

/// Measure and first moments of what figures cover at a value of x: length, and the integral of y.
std::array<double, 2> section(const std::vector<std::vector<glm::dvec2>>& figures, double x) {
  std::vector<std::array<double, 2>> spans;
  for (const auto& f : figures) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = 0; i < f.size(); ++i) {
      const glm::dvec2 a = f[i], b = f[(i + 1) % f.size()];
      if ((a.x - x) * (b.x - x) > 0.0 || a.x == b.x) continue;
      const double y = a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
      low = std::min(low, y);
      high = std::max(high, y);
    }
    if (low < high) spans.push_back({low, high});
  }
  std::sort(spans.begin(), spans.end());
  std::array<double, 2> sum{0.0, 0.0};
  double done = -std::numeric_limits<double>::infinity();
  for (const auto& [low, high] : spans) {
    const double from = std::max(low, done);
    if (high > from) {
      sum[0] += high - from;
      sum[1] += 0.5 * (high * high - from * from);
      done = high;
    }
  }
  return sum;
}

/// Area and centroid of a union of convex polygons: between any two of their corners and crossings along x
/// the section is linear, so that Simpson's rule is exact.
std::pair<double, glm::dvec2> unionOf(const std::vector<std::vector<glm::dvec2>>& figures) {
  std::vector<double> cuts;
  for (const auto& f : figures) {
    for (std::size_t i = 0; i < f.size(); ++i) {
      const glm::dvec2 p = f[i], e = f[(i + 1) % f.size()] - p;
      cuts.push_back(p.x);
      for (const auto& g : figures) {
        for (std::size_t j = 0; &g != &f && j < g.size(); ++j) {
          const glm::dvec2 q = g[j], h = g[(j + 1) % g.size()] - q;
          const double c = cross2(e, h), s = cross2(q - p, h) / c;
          if (c != 0.0 && s > 0.0 && s < 1.0) cuts.push_back(p.x + s * e.x);
        }
      }
    }
  }
  std::sort(cuts.begin(), cuts.end());
  double area = 0.0;
  glm::dvec2 moment(0.0);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double width = cuts[i + 1] - cuts[i];
    // Gauss's points, which shun the ends.
    for (const double at : {0.5 - 0.5 * std::sqrt(1.0 / 3.0), 0.5 + 0.5 * std::sqrt(1.0 / 3.0)}) {
      const double x = cuts[i] + at * width;
      const auto [length, y] = section(figures, x);
      area += 0.5 * width * length;
      moment += 0.5 * width * glm::dvec2(x * length, y);
    }
  }
  return {area, moment / area};
}

/// Length and centroid of segments; those that run along an earlier one are cut at its ends.
std::pair<double, glm::dvec3> unionOfSegments(const std::vector<Points>& segments, double tolerance) {
  double length = 0.0;
  glm::dvec3 moment(0.0);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const glm::dvec3 a = segments[i][0], e = segments[i][1] - a;
    std::vector<std::array<double, 2>> covered;
    std::vector<double> cuts{0.0, 1.0};
    for (std::size_t j = 0; j < i; ++j) {
      std::array<double, 2> s;
      bool isAlong = true;
      for (std::size_t k = 0; k < 2; ++k) {
        const glm::dvec3 w = segments[j][k] - a;
        s[k] = glm::dot(w, e) / glm::dot(e, e);
        isAlong = isAlong && glm::distance(w, s[k] * e) <= tolerance;
      }
      if (!isAlong) continue;
      std::sort(s.begin(), s.end());
      covered.push_back(s);
      for (const double cut : s)
        cuts.push_back(std::clamp(cut, 0.0, 1.0));
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
      const double middle = 0.5 * (cuts[k] + cuts[k + 1]);
      const bool isCovered = std::any_of(covered.begin(), covered.end(),
                                         [&](auto& c) { return c[0] <= middle && middle <= c[1]; });
      const double part = isCovered ? 0.0 : (cuts[k + 1] - cuts[k]) * glm::length(e);
      length += part;
      moment += part * (a + middle * e);
    }
  }
  return {length, moment / length};
}

OracleRegion regionOf(const std::vector<Piece>& pieces, const std::vector<std::size_t>& members,
                      double tolerance) {
  OracleRegion region{1, {}, {}, 0.0, std::numeric_limits<double>::infinity(), {}};
  for (const std::size_t i : members)
    region.dimension = std::max(region.dimension, pieces[i].dimension);
  for (const std::size_t i : members) {
    region.least = std::min(region.least, pieces[i].least);
    if (pieces[i].dimension != region.dimension) continue;
    region.pieces.push_back(pieces[i].points);
    region.direction = pieces[i].direction;
  }
  if (region.dimension == 1) {
    std::tie(region.measure, region.centroid) = unionOfSegments(region.pieces, tolerance);
    return region;
  }
  const Frame frame(region.pieces[0][0], region.direction);
  std::vector<std::vector<glm::dvec2>> flat;
  for (const Points& piece : region.pieces) {
    flat.emplace_back();
    for (const glm::dvec3& p : piece)
      flat.back().push_back(frame.flat(p));
  }
  glm::dvec2 centroid;
  std::tie(region.measure, centroid) = unionOf(flat);
  region.centroid = frame.solid(centroid);
  return region;
}

std::vector<Piece> findPieces(const OracleBody& scene, const OracleBody& part,
                              const RigidTransform& sceneFromPart, double cutoff) {
  const double size = scene.size() + part.size();
  std::vector<Piece> pieces;
  for (const Feature& local : part.features()) {
    if (local.kind == 'v') continue;
    const Feature b = moved(local, sceneFromPart);
    const auto along = [](const Feature& e) { return glm::normalize(e.corners[1] - e.corners[0]); };
    for (const Feature& a : scene.features()) {
      const char kinds[3] = {a.kind, b.kind, '\0'};
      const std::string pair(kinds);
      if (pair == "ff" && glm::distance(a.outward, -b.outward) <= kParallel)
        addFacePiece(a, b, true, size, pieces);
      if (pair == "fe" && std::abs(glm::dot(a.outward, along(b))) <= kParallel && faces(b, -a.outward))
        addFacePiece(a, b, true, size, pieces);
      if (pair == "ef" && std::abs(glm::dot(b.outward, along(a))) <= kParallel && faces(a, -b.outward))
        addFacePiece(b, a, false, size, pieces);
      if (pair == "ee" && glm::length(glm::cross(along(a), along(b))) <= kParallel)
        addEdgePiece(a, b, size, pieces);
    }
  }
  std::erase_if(pieces, [cutoff](const Piece& p) { return p.least > cutoff; });
  return pieces;
}

}  // namespace

std::vector<OracleRegion> bruteForceRegions(const OracleBody& scene, const OracleBody& part,
                                            const RigidTransform& sceneFromPart, double cutoff) {
  const double tolerance = 1e-9 * (scene.size() + part.size());
  const std::vector<Piece> pieces = findPieces(scene, part, sceneFromPart, cutoff);
  std::vector<OracleRegion> regions;
  std::vector<bool> isTaken(pieces.size(), false);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (isTaken[i]) continue;
    std::vector<std::size_t> members{i};
    isTaken[i] = true;
    for (std::size_t k = 0; k < members.size(); ++k) {
      for (std::size_t j = 0; j < pieces.size(); ++j) {
        if (isTaken[j] || !touches(pieces[members[k]], pieces[j], tolerance)) continue;
        isTaken[j] = true;
        members.push_back(j);
      }
    }
    regions.push_back(regionOf(pieces, members, tolerance));
  }
  return regions;
}

bool isOfRegion(const OracleMinimum& minimum, const OracleRegion& region, double tolerance) {
  return std::any_of(region.pieces.begin(), region.pieces.end(), [&](const Points& piece) {
    return pointPieceDistance(minimum.scenePoint, piece, region.direction) <= tolerance &&
           std::abs(minimum.distance - region.least) <= tolerance;
  });
}

}  // namespace nearfit::test
