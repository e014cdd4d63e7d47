#include "core/mesh/ray_tree.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#include "core/math/box_split.h"

namespace nearfit {
namespace {

constexpr std::size_t kMaxInLeaf = 8;
/// How far from a triangle a ray still meets it, as a fraction of the mesh's largest coordinate: a hundred times
/// what rounding needs, and a millionth of a pixel for a part that fills the view.
constexpr double kRaySlack = 1e-9;
/// Fraction of a ray that meets nothing.
constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

RayTree::RayTree(TriangleMesh mesh)
    : mesh_(std::move(mesh)), slack_(kRaySlack * mesh_.bounds().largestCoordinate()) {
  std::vector<Entry> entries(mesh_.triangles().size());
  for (std::uint32_t i = 0; i < entries.size(); ++i) {
    entries[i].triangle = i;
    for (const std::uint32_t corner : mesh_.triangles()[i])
      entries[i].box.add(mesh_.vertices()[corner]);
  }
  order_.reserve(entries.size());
  if (!entries.empty()) makeNode(entries);
  nodes_.shrink_to_fit();
}

std::uint32_t RayTree::makeNode(std::span<Entry> entries) {
  const auto at = static_cast<std::uint32_t>(nodes_.size());
  Node node;
  for (const Entry& entry : entries) {
    node.box.add(entry.box.lower);
    node.box.add(entry.box.upper);
  }
  nodes_.push_back(node);
  if (entries.size() > kMaxInLeaf) {
    const std::size_t cut = splitBoxes(entries);
    makeNode(entries.first(cut));
    const std::uint32_t right = makeNode(entries.subspan(cut));
    nodes_[at].right = right;
    return at;
  }
  nodes_[at].begin = static_cast<std::uint32_t>(order_.size());
  nodes_[at].count = static_cast<std::uint32_t>(entries.size());
  for (const Entry& entry : entries)
    order_.push_back(entry.triangle);
  return at;
}

std::optional<RayHit> RayTree::firstHit(const glm::dvec3& from, const glm::dvec3& to) const noexcept {
  if (nodes_.empty()) return std::nullopt;
  const Ray ray{from, to - from};
  RayHit hit;
  hit.fraction = kNever;
  if (entryOf(nodes_[0].box, ray) < kNever) search(0, ray, hit);
  return hit.fraction < kNever ? std::optional(hit) : std::nullopt;
}

/// Fraction at which a ray comes within the slack of a box; kNever if it does not.
double RayTree::entryOf(const Aabb& box, const Ray& ray) const noexcept {
  double first = 0.0, last = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = box.lower[axis] - slack_ - ray.from[axis];
    const double upper = box.upper[axis] + slack_ - ray.from[axis];
    const double along = ray.along[axis];
    if (along == 0.0) {
      if (lower > 0.0 || upper < 0.0) return kNever;
      continue;
    }
    const double a = lower / along, b = upper / along;
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first <= last ? first : kNever;
}

/// Recursive, no deeper than the hierarchy; see splitBoxes().
void RayTree::search(std::uint32_t at, const Ray& ray, RayHit& hit) const noexcept {
  const Node& node = nodes_[at];
  for (std::uint32_t i = 0; i < node.count; ++i)
    meet(order_[node.begin + i], ray, hit);
  if (node.count > 0) return;
  std::uint32_t near = at + 1, far = node.right;
  double toNear = entryOf(nodes_[near].box, ray), toFar = entryOf(nodes_[far].box, ray);
  if (toFar < toNear) {
    std::swap(near, far);
    std::swap(toNear, toFar);
  }
  if (toNear < hit.fraction) search(near, ray, hit);
  if (toFar < hit.fraction) search(far, ray, hit);
}

void RayTree::meet(std::uint32_t triangle, const Ray& ray, RayHit& hit) const noexcept {
  const Triangle& t = mesh_.triangles()[triangle];
  const TriangleCorners corners{mesh_.vertices()[t[0]], mesh_.vertices()[t[1]], mesh_.vertices()[t[2]]};
  const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double across = glm::dot(normal, ray.along);
  if (across == 0.0) return;
  const double fraction = glm::dot(normal, corners[0] - ray.from) / across;
  // NaN is not within.
  if (!(fraction >= 0.0 && fraction <= 1.0 && fraction < hit.fraction)) return;
  const glm::dvec3 point = ray.from + fraction * ray.along;
  if (isWithin(point, corners, normal)) hit = {fraction, triangle, point};
}

/// True if a point of the triangle's plane is in it, or no farther than the slack beyond its sides; false for NaN.
bool RayTree::isWithin(const glm::dvec3& point, const TriangleCorners& corners,
                       const glm::dvec3& normal) const noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 side = corners[(k + 1) % 3] - corners[k];
    const double inside = glm::dot(glm::cross(side, point - corners[k]), normal);
    if (!(inside >= -slack_ * glm::length(side) * glm::length(normal))) return false;
  }
  return true;
}

std::size_t RayTree::byteSize() const noexcept {
  return nodes_.capacity() * sizeof(Node) + order_.capacity() * sizeof(std::uint32_t);
}

}  // namespace nearfit
