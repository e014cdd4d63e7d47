#include "core/placing/edge_chain.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include <glm/geometric.hpp>

#include "core/placing/mesh_region.h"

namespace nearfit {
namespace {

/// Max distance of corners from a circle, as a fraction of its radius, and from a line, as a
/// fraction of the mesh.
constexpr double kOffCircle = 2e-3, kOffLine = 2e-6;
constexpr std::size_t kFewestCorners = 5;

using Chain = std::deque<std::uint32_t>;

/// Far ends of the sharp edges that continue a chain at `at`, coming from `from`.
std::vector<std::uint32_t> nextOf(const TriangleMesh& mesh, std::uint32_t at, std::uint32_t from) {
  std::vector<std::uint32_t> next;
  for (const std::uint32_t edge : mesh.edgesOfVertex(at)) {
    const MeshEdge& e = mesh.edges()[edge];
    const std::uint32_t other = e.v0 == at ? e.v1 : e.v0;
    if (other != from && isSharp(mesh, edge)) next.push_back(other);
  }
  return next;
}

/// Extends a chain at its end while a fitting corner follows. True if that closes it.
template <class Fits>
bool lengthen(const TriangleMesh& mesh, Chain& chain, Fits&& fits) {
  for (;;) {
    const std::uint32_t at = chain.back(), from = chain[chain.size() - 2];
    const glm::dvec3 along = mesh.vertices()[at] - mesh.vertices()[from];
    bool hasGrown = false;
    for (const std::uint32_t next : nextOf(mesh, at, from)) {
      const glm::dvec3 on = mesh.vertices()[next] - mesh.vertices()[at];
      const double turn = std::atan2(glm::length(glm::cross(along, on)), glm::dot(along, on));
      if (turn > kSharpTurn + 1e-3 || !fits(mesh.vertices()[next])) continue;
      if (next == chain.front()) return true;
      chain.push_back(next);
      hasGrown = true;
      break;
    }
    // More corners than vertices: it would run in circles.
    if (!hasGrown || chain.size() > mesh.vertices().size()) return false;
  }
}

template <class Fits>
Chain chainOf(const TriangleMesh& mesh, const MeshEdge& edge, Fits&& fits) {
  Chain chain{edge.v0, edge.v1};
  if (lengthen(mesh, chain, fits)) {
    chain.push_back(chain.front());
    return chain;
  }
  std::reverse(chain.begin(), chain.end());
  lengthen(mesh, chain, fits);
  return chain;
}

std::vector<glm::dvec3> pointsOf(const TriangleMesh& mesh, const Chain& chain) {
  std::vector<glm::dvec3> points;
  const bool isClosed = chain.size() > 2 && chain.front() == chain.back();
  for (std::size_t i = isClosed ? 1 : 0; i < chain.size(); ++i)
    points.push_back(mesh.vertices()[chain[i]]);
  return points;
}

EdgeChain straightChain(const TriangleMesh& mesh, const MeshEdge& edge) {
  const glm::dvec3 point = mesh.vertices()[edge.v0];
  const glm::dvec3 along = glm::normalize(mesh.vertices()[edge.v1] - point);
  const double slack = kOffLine * mesh.bounds().diagonal();
  const Chain chain = chainOf(
      mesh, edge, [&](const glm::dvec3& p) { return glm::length(glm::cross(p - point, along)) <= slack; });
  EdgeChain result;
  result.vertices.assign(chain.begin(), chain.end());
  const glm::dvec3 first = mesh.vertices()[chain.front()], last = mesh.vertices()[chain.back()];
  result.circle = {0.5 * (first + last), glm::normalize(last - first), 0.0};
  return result;
}

/// The round chain through an edge and a corner adjacent to one of its ends.
std::optional<EdgeChain> roundChain(const TriangleMesh& mesh, const MeshEdge& edge, std::uint32_t beyond) {
  const glm::dvec3 three[] = {mesh.vertices()[edge.v0], mesh.vertices()[edge.v1], mesh.vertices()[beyond]};
  std::optional<Circle> circle = fitCircle(three);
  if (!circle) return std::nullopt;
  EdgeChain result;
  // Fit again with all corners: three close ones determine the circle poorly.
  for (int round = 0; round < 2; ++round) {
    const double slack = (round == 0 ? 5.0 : 1.0) * kOffCircle * circle->radius;
    const Chain chain =
        chainOf(mesh, edge, [&](const glm::dvec3& p) { return circle->distanceFrom(p) <= slack; });
    if (chain.size() < kFewestCorners) return std::nullopt;
    circle = fitCircle(pointsOf(mesh, chain));
    if (!circle) return std::nullopt;
    result.vertices.assign(chain.begin(), chain.end());
  }
  for (const std::uint32_t v : result.vertices) {
    if (circle->distanceFrom(mesh.vertices()[v]) > kOffCircle * circle->radius) return std::nullopt;
  }
  result.isRound = true;
  result.circle = *circle;
  return result;
}

}  // namespace

EdgeChain edgeChain(const TriangleMesh& mesh, std::uint32_t sharpEdge) {
  const MeshEdge& edge = mesh.edges()[sharpEdge];
  std::optional<EdgeChain> best;
  for (const auto& [at, from] : {std::pair(edge.v1, edge.v0), std::pair(edge.v0, edge.v1)}) {
    for (const std::uint32_t beyond : nextOf(mesh, at, from)) {
      std::optional<EdgeChain> found = roundChain(mesh, edge, beyond);
      if (found && (!best || found->vertices.size() > best->vertices.size())) best = std::move(found);
    }
  }
  return best ? *best : straightChain(mesh, edge);
}

}  // namespace nearfit
