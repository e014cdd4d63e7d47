#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/mixed_bits.h"
#include "core/mesh/check/face_faults.h"
#include "core/mesh/check/mesh_repair.h"
#include "core/mesh/check/nearest_surface.h"
#include "core/mesh/flat_triangles.h"

namespace nearfit {
namespace {

/// Samples between two reports of progress.
constexpr std::size_t kSamplesPerReport = 1024;

MeshChange::Side sideOf(const TriangleMesh& mesh) {
  MeshChange::Side side{
      mesh.triangles().size(), mesh.topology().openEdges, mesh.topology().components, 0.0, {}};
  const glm::dvec3 centre = mesh.bounds().centre();
  double volume = 0.0;
  for (const Triangle& t : mesh.triangles()) {
    const glm::dvec3 a = mesh.vertices()[t[0]] - centre, b = mesh.vertices()[t[1]] - centre,
                     c = mesh.vertices()[t[2]] - centre;
    side.area += 0.5 * glm::length(glm::cross(b - a, c - a));
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  if (mesh.topology().isClosed() && mesh.topology().isOriented()) side.volume = volume;
  return side;
}

/// The same for triangles with the same corners, in whatever order.
std::uint64_t hashOfTriangle(const TriangleMesh& mesh, const Triangle& t) {
  std::array<std::uint64_t, 3> corners{};
  for (std::size_t k = 0; k < 3; ++k) {
    // Adding zero makes both zeros one.
    const glm::dvec3 p = mesh.vertices()[t[k]] + glm::dvec3(0.0);
    for (const double x : {p.x, p.y, p.z})
      corners[k] = mixedBits(corners[k] ^ std::bit_cast<std::uint64_t>(x));
  }
  std::ranges::sort(corners);
  return mixedBits(mixedBits(mixedBits(corners[0]) ^ corners[1]) ^ corners[2]);
}

std::vector<std::uint64_t> sortedHashes(const TriangleMesh& mesh) {
  std::vector<std::uint64_t> hashes;
  hashes.reserve(mesh.triangles().size());
  for (const Triangle& t : mesh.triangles())
    hashes.push_back(hashOfTriangle(mesh, t));
  std::ranges::sort(hashes);
  return hashes;
}

/// Triangles with an area of a mesh that another one does not have.
std::vector<std::uint32_t> trianglesMissingIn(const std::vector<std::uint64_t>& other,
                                              const TriangleMesh& mesh) {
  // A line that sticks out was no surface that moved.
  const double noHeight = kNoHeight * mesh.bounds().diagonal();
  std::vector<std::uint32_t> missing;
  for (std::uint32_t i = 0; i < mesh.triangles().size(); ++i) {
    const Triangle& t = mesh.triangles()[i];
    if (std::ranges::binary_search(other, hashOfTriangle(mesh, t))) continue;
    if (leastHeight(mesh.vertices(), t) > noHeight) missing.push_back(i);
  }
  return missing;
}

std::array<glm::dvec3, 7> samplesOf(const TriangleMesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles()[triangle];
  const glm::dvec3 a = mesh.vertices()[t[0]], b = mesh.vertices()[t[1]], c = mesh.vertices()[t[2]];
  return {a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (a + b + c) / 3.0};
}

class DistanceMeter {
 public:
  explicit DistanceMeter(const std::function<void(double)>& report) : report_(report) {}

  /// Measures from triangles of a mesh to another mesh.
  void measure(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles,
               const TriangleMesh& other, MeshChange& change) const {
    if (triangles.empty()) return;
    const NearestSurface surface(other);
    constexpr std::size_t kMaxTriangles = MeshChange::kMaxSamples / 2 / 7;
    const std::size_t stride = 1 + (triangles.size() - 1) / kMaxTriangles;
    change.isSampled = change.isSampled || stride > 1;
    for (std::size_t i = 0; i < triangles.size(); i += stride) {
      if ((i / stride) % kSamplesPerReport == 0)
        report_(static_cast<double>(i) / static_cast<double>(triangles.size()));
      for (const glm::dvec3& point : samplesOf(mesh, triangles[i]))
        change.maxDistance = std::max(change.maxDistance, surface.distance(point));
    }
  }

 private:
  const std::function<void(double)>& report_;
};

}  // namespace

MeshChange changeBetween(const TriangleMesh& before, const TriangleMesh& after,
                         const ProgressCallback& progress) {
  MeshChange change;
  change.before = sideOf(before);
  change.after = sideOf(after);
  if (before.sharesArraysOf(after)) return change;
  const std::vector<std::uint32_t> gone = trianglesMissingIn(sortedHashes(after), before),
                                   added = trianglesMissingIn(sortedHashes(before), after);
  const std::function<void(double)> first = stageOf(progress, 0.0, 0.5), second = stageOf(progress, 0.5, 1.0);
  DistanceMeter(first).measure(before, gone, after, change);
  const double ofRemoved = change.maxDistance;
  DistanceMeter(second).measure(after, added, before, change);
  change.isOfRemoved = ofRemoved > 0.0 && ofRemoved >= change.maxDistance;
  second(1.0);
  return change;
}

}  // namespace nearfit
