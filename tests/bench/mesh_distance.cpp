#include "tests/bench/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace nearfit::bench {
namespace {

constexpr std::uint32_t kLeaf = 4;

double squaredToBox(const Aabb& box, const glm::dvec3& p) {
  const glm::dvec3 outside = glm::max(glm::max(box.lower - p, p - box.upper), glm::dvec3(0.0));
  return glm::dot(outside, outside);
}

/// By the region of the triangle's plane that the point is over: Ericson, Real-Time Collision
/// Detection, 5.1.5.
double squaredToTriangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p) {
  const auto squaredTo = [&p](const glm::dvec3& q) { return glm::dot(p - q, p - q); };
  const glm::dvec3 ab = b - a, ac = c - a;
  const double abA = glm::dot(ab, p - a), acA = glm::dot(ac, p - a);
  if (abA <= 0.0 && acA <= 0.0) return squaredTo(a);
  const double abB = glm::dot(ab, p - b), acB = glm::dot(ac, p - b);
  if (abB >= 0.0 && acB <= abB) return squaredTo(b);
  const double areaC = abA * acB - abB * acA;
  if (areaC <= 0.0 && abA >= 0.0 && abB <= 0.0) return squaredTo(a + abA / (abA - abB) * ab);
  const double abC = glm::dot(ab, p - c), acC = glm::dot(ac, p - c);
  if (acC >= 0.0 && abC <= acC) return squaredTo(c);
  const double areaB = abC * acA - abA * acC;
  if (areaB <= 0.0 && acA >= 0.0 && acC <= 0.0) return squaredTo(a + acA / (acA - acC) * ac);
  const double areaA = abB * acC - abC * acB, fromB = acB - abB, fromC = abC - acC;
  if (areaA <= 0.0 && fromB >= 0.0 && fromC >= 0.0) return squaredTo(b + fromB / (fromB + fromC) * (c - b));
  const glm::dvec3 n = glm::cross(ab, ac);
  const double height = glm::dot(n, p - a);
  return height * height / glm::dot(n, n);
}

}  // namespace

MeshDistance::MeshDistance(const TriangleMesh& mesh) : mesh_(mesh), order_(mesh.triangles().size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  std::vector<glm::dvec3> centres;
  const auto x = mesh.vertices();
  for (const Triangle& t : mesh.triangles())
    centres.push_back((x[t[0]] + x[t[1]] + x[t[2]]) / 3.0);
  nodes_.push_back({{}, 0, static_cast<std::uint32_t>(order_.size()), 0});
  build(0, centres);
}

void MeshDistance::build(std::uint32_t node, std::span<const glm::dvec3> centres) {
  const auto begin = order_.begin() + nodes_[node].first;
  const auto end = begin + nodes_[node].count;
  Aabb middle;
  for (auto it = begin; it != end; ++it) {
    middle.add(centres[*it]);
    for (const std::uint32_t v : mesh_.triangles()[*it])
      nodes_[node].box.add(mesh_.vertices()[v]);
  }
  if (nodes_[node].count <= kLeaf) return;
  const glm::dvec3 size = middle.upper - middle.lower;
  const glm::length_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t first = nodes_[node].first, half = nodes_[node].count / 2;
  std::nth_element(begin, begin + half, end,
                   [&](std::uint32_t a, std::uint32_t b) { return centres[a][axis] < centres[b][axis]; });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  const std::uint32_t rest = nodes_[node].count - half;
  nodes_[node].child = child;
  nodes_.push_back({{}, first, half, 0});
  nodes_.push_back({{}, first + half, rest, 0});
  build(child, centres);
  build(child + 1, centres);
}

double MeshDistance::of(const glm::dvec3& point, double atMost) const {
  Best best{atMost * atMost, 0};
  search(0, point, best);
  return std::sqrt(best.squared);
}

double MeshDistance::ofNext(const glm::dvec3& point, std::uint32_t& triangle) const {
  Best best{squaredTo(triangle, point), triangle};
  search(0, point, best);
  triangle = best.triangle;
  return std::sqrt(best.squared);
}

double MeshDistance::squaredTo(std::uint32_t triangle, const glm::dvec3& point) const {
  const Triangle& t = mesh_.triangles()[triangle];
  const auto x = mesh_.vertices();
  return squaredToTriangle(x[t[0]], x[t[1]], x[t[2]], point);
}

void MeshDistance::search(std::uint32_t node, const glm::dvec3& point, Best& best) const {
  const Node& n = nodes_[node];
  if (n.child == 0) {
    for (std::uint32_t i = n.first; i < n.first + n.count; ++i) {
      const double squared = squaredTo(order_[i], point);
      if (squared < best.squared) best = {squared, order_[i]};
    }
    return;
  }
  const double a = squaredToBox(nodes_[n.child].box, point), b = squaredToBox(nodes_[n.child + 1].box, point);
  const std::uint32_t nearer = n.child + (b < a ? 1 : 0), farther = n.child + (b < a ? 0 : 1);
  if (std::min(a, b) < best.squared) search(nearer, point, best);
  if (std::max(a, b) < best.squared) search(farther, point, best);
}

}  // namespace nearfit::bench
