#include "core/section/mesh_section.h"

#include <algorithm>
#include <exception>
#include <unordered_map>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/exact/outline_fill.h"

namespace nearfit {
namespace {

/// Vertices nearer to the plane lie in it, as a fraction of the mesh's size: more than the
/// rounding of its pose.
constexpr double kInPlane = 1e-11;
/// Max segments of a filled outline: takes about 50 ms. More would delay the view.
constexpr std::size_t kMaxFilled = 25'000;

/// Builds the outline, with one point per cut edge.
class Outline {
 public:
  Outline(const TriangleMesh& mesh, const CutPlane& plane, MeshSection& section)
      : mesh_(mesh), plane_(plane), section_(section) {}

  void cut(std::uint32_t triangle, const std::array<bool, 3>& isAway) {
    // `alone` is the corner on its own side. Seen from outside with the normal up, the segment runs from left
    // to right below a corner that is cut away.
    const int alone = isAway[1] == isAway[2] ? 0 : isAway[0] == isAway[2] ? 1 : 2;
    const auto& edges = mesh_.edgesOfTriangle(triangle);
    const std::uint32_t after = pointOf(edges[static_cast<std::size_t>(alone)]);
    const std::uint32_t before = pointOf(edges[static_cast<std::size_t>((alone + 2) % 3)]);
    if (isAway[static_cast<std::size_t>(alone)]) {
      section_.outline.push_back({after, before});
    } else {
      section_.outline.push_back({before, after});
    }
  }

 private:
  std::uint32_t pointOf(std::uint32_t edge) {
    const auto [entry, isNew] = points_.try_emplace(edge, static_cast<std::uint32_t>(section_.points.size()));
    if (isNew) {
      const glm::dvec3 a = mesh_.vertices()[mesh_.edges()[edge].v0];
      const glm::dvec3 b = mesh_.vertices()[mesh_.edges()[edge].v1];
      const double from = plane_.heightOf(a), to = plane_.heightOf(b);
      // One end may be slightly beyond the plane, within tolerance.
      section_.points.push_back(a + std::clamp(from / (from - to), 0.0, 1.0) * (b - a));
    }
    return entry->second;
  }

  const TriangleMesh& mesh_;
  const CutPlane& plane_;
  MeshSection& section_;
  std::unordered_map<std::uint32_t, std::uint32_t> points_;
};

void gatherOutline(const TriangleMesh& mesh, const CutPlane& plane, MeshSection& section) {
  const double tolerance = kInPlane * mesh.bounds().diagonal();
  std::vector<std::uint8_t> isAway(mesh.vertices().size());
  for (std::size_t v = 0; v < isAway.size(); ++v)
    isAway[v] = plane.heightOf(mesh.vertices()[v]) > tolerance ? 1 : 0;
  Outline outline(mesh, plane, section);
  for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    const Triangle& c = mesh.triangles()[t];
    const std::array corners{isAway[c[0]] != 0, isAway[c[1]] != 0, isAway[c[2]] != 0};
    if (corners[0] != corners[1] || corners[0] != corners[2]) outline.cut(t, corners);
  }
}

void fill(const CutPlane& plane, FillRule rule, MeshSection& section) {
  const auto [right, up] = axesOf(plane);
  std::vector<glm::dvec2> flat;
  flat.reserve(section.points.size());
  for (const glm::dvec3& p : section.points)
    flat.emplace_back(glm::dot(p, right), glm::dot(p, up));
  FilledOutline filled = fillOutline(flat, section.outline, rule);
  section.capPoints.reserve(filled.points.size());
  for (const glm::dvec2& p : filled.points)
    section.capPoints.push_back(plane.offset * plane.normal + p.x * right + p.y * up);
  section.cap = std::move(filled.triangles);
}

}  // namespace

MeshSection sectionOf(const TriangleMesh& mesh, const CutPlane& plane) {
  MeshSection section;
  section.isCapped = mesh.topology().isClosed();
  if (mesh.bounds().isEmpty()) return section;
  const auto [low, high] = reachAlong(mesh.bounds(), plane.normal);
  if (plane.offset < low || plane.offset > high) return section;
  gatherOutline(mesh, plane, section);
  section.isCapped = section.isCapped && section.outline.size() <= kMaxFilled;
  if (!section.isCapped || section.outline.empty()) return section;
  try {
    fill(plane, mesh.topology().isOriented() ? FillRule::Wound : FillRule::Odd, section);
  } catch (const std::exception&) {
    // The outline alone still shows the cut.
    section.capPoints.clear();
    section.cap.clear();
    section.isCapped = false;
  }
  return section;
}

bool isOnCap(const MeshSection& section, const glm::dvec3& normal, const glm::dvec3& point) noexcept {
  const auto isLeft = [&](const glm::dvec3& from, const glm::dvec3& to) {
    return glm::dot(glm::cross(to - from, point - from), normal) >= 0.0;
  };
  return std::ranges::any_of(section.cap, [&](const Triangle& t) {
    const glm::dvec3 &a = section.capPoints[t[0]], &b = section.capPoints[t[1]], &c = section.capPoints[t[2]];
    return isLeft(a, b) && isLeft(b, c) && isLeft(c, a);
  });
}

}  // namespace nearfit
