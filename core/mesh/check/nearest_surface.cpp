#include "core/mesh/check/nearest_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/math/box_split.h"
#include "core/math/nearest_on_segment.h"
#include "core/math/triangle_corners.h"

namespace nearfit {
namespace {

constexpr std::size_t kTrianglesPerLeaf = 8;

double squaredLength(const glm::dvec3& v) {
  return glm::dot(v, v);
}

double squaredToBox(const Aabb& box, const glm::dvec3& point) {
  return squaredLength(point - glm::clamp(point, box.lower, box.upper));
}

/// True if the point's foot on the plane of the triangle is within it. False for one without area.
bool isOver(const TriangleCorners& t, const glm::dvec3& point, const glm::dvec3& normal) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(glm::dot(glm::cross(t[(k + 1) % 3] - t[k], point - t[k]), normal) >= 0.0)) return false;
  }
  return squaredLength(normal) > 0.0;
}

double squaredToTriangle(const TriangleCorners& t, const glm::dvec3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k)
    least = std::min(least, squaredLength(point - nearestOnSegment(t[k], t[(k + 1) % 3], point)));
  const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  if (!isOver(t, point, normal)) return least;
  const double height = glm::dot(point - t[0], normal);
  return std::min(least, height * height / squaredLength(normal));
}

}  // namespace

NearestSurface::NearestSurface(TriangleMesh mesh) : mesh_(std::move(mesh)) {
  std::vector<Entry> entries(mesh_.triangles().size());
  for (std::uint32_t i = 0; i < entries.size(); ++i) {
    entries[i].triangle = i;
    for (const std::uint32_t v : mesh_.triangles()[i])
      entries[i].box.add(mesh_.vertices()[v]);
  }
  order_.reserve(entries.size());
  if (!entries.empty()) makeNode(entries);
}

std::uint32_t NearestSurface::makeNode(std::span<Entry> entries) {
  const auto at = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  if (entries.size() <= kTrianglesPerLeaf) {
    Node leaf;
    leaf.begin = static_cast<std::uint32_t>(order_.size());
    leaf.count = static_cast<std::uint32_t>(entries.size());
    for (const Entry& entry : entries) {
      leaf.box.add(entry.box.lower);
      leaf.box.add(entry.box.upper);
      order_.push_back(entry.triangle);
    }
    nodes_[at] = leaf;
    return at;
  }
  const std::size_t cut = splitBoxes(entries);
  const std::uint32_t left = makeNode(entries.first(cut)), right = makeNode(entries.subspan(cut));
  Node& node = nodes_[at];
  node.right = right;
  for (const std::uint32_t child : {left, right}) {
    node.box.add(nodes_[child].box.lower);
    node.box.add(nodes_[child].box.upper);
  }
  return at;
}

double NearestSurface::distance(const glm::dvec3& point) const noexcept {
  double squared = std::numeric_limits<double>::infinity();
  if (!nodes_.empty()) search(0, point, squared);
  return std::sqrt(squared);
}

void NearestSurface::search(std::uint32_t at, const glm::dvec3& point, double& squared) const noexcept {
  const Node& node = nodes_[at];
  if (node.count > 0) {
    for (const std::uint32_t i : std::span(order_).subspan(node.begin, node.count)) {
      const Triangle& t = mesh_.triangles()[i];
      const TriangleCorners corners{mesh_.vertices()[t[0]], mesh_.vertices()[t[1]], mesh_.vertices()[t[2]]};
      squared = std::min(squared, squaredToTriangle(corners, point));
    }
    return;
  }
  std::uint32_t nearer = at + 1, farther = node.right;
  double toNearer = squaredToBox(nodes_[nearer].box, point),
         toFarther = squaredToBox(nodes_[farther].box, point);
  if (toFarther < toNearer) {
    std::swap(nearer, farther);
    std::swap(toNearer, toFarther);
  }
  if (toNearer < squared) search(nearer, point, squared);
  if (toFarther < squared) search(farther, point, squared);
}

}  // namespace nearfit
