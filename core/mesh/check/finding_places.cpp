#include "core/mesh/check/finding_places.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

std::uint32_t rootOf(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) {
    parent[i] = parent[parent[i]];
    i = parent[i];
  }
  return i;
}

/// A point of the surface in the middle of what is shown.
glm::dvec3 pointOf(const MeshFinding& finding) {
  const glm::dvec3 centre = finding.box.centre();
  glm::dvec3 best = centre;
  double least = std::numeric_limits<double>::infinity();
  const auto offer = [&](const glm::dvec3& p) {
    const double distance = glm::distance(p, centre);
    if (distance < least) {
      least = distance;
      best = p;
    }
  };
  for (const auto& [from, to] : finding.edges)
    offer(0.5 * (from + to));
  for (const TriangleCorners& t : finding.triangles)
    offer((t[0] + t[1] + t[2]) / 3.0);
  return best;
}

}  // namespace

void FindingPlaces::add(const Defect& defect) {
  const auto append = [](std::vector<std::uint32_t>& all, const std::vector<std::uint32_t>& own) {
    const auto first = static_cast<std::uint32_t>(all.size());
    all.insert(all.end(), own.begin(), own.end());
    return first;
  };
  Kept kept{};
  kept.firstVertex = append(vertices_, defect.vertices);
  kept.vertexCount = static_cast<std::uint32_t>(defect.vertices.size());
  kept.firstEdge = append(edges_, defect.edges);
  kept.edgeCount = static_cast<std::uint32_t>(defect.edges.size());
  kept.firstTriangle = append(triangles_, defect.triangles);
  kept.triangleCount = static_cast<std::uint32_t>(defect.triangles.size());
  kept.severity = defect.severity;
  kept.length = defect.length;
  kept.count = defect.count;
  defects_.push_back(kept);
}

void FindingPlaces::addEdge(std::uint32_t edge, FindingSeverity severity) {
  const MeshEdge& e = mesh_.edges()[edge];
  add({{e.v0, e.v1}, {edge}, {}, severity, 0.0, 1});
}

/// Number of each defect's place, from 0, in the order of their first defects.
std::vector<std::uint32_t> FindingPlaces::placesOfDefects() const {
  std::unordered_map<std::uint32_t, std::uint32_t> firstAt;
  std::vector<std::uint32_t> parent(defects_.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (std::uint32_t i = 0; i < defects_.size(); ++i) {
    for (std::uint32_t k = 0; k < defects_[i].vertexCount; ++k) {
      const auto [first, isNew] = firstAt.try_emplace(vertices_[defects_[i].firstVertex + k], i);
      if (isNew) continue;
      const std::uint32_t a = rootOf(parent, first->second), b = rootOf(parent, i);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<std::uint32_t> place(defects_.size());
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < defects_.size(); ++i) {
    const std::uint32_t root = rootOf(parent, i);
    place[i] = root == i ? count++ : place[root];
  }
  return place;
}

void FindingPlaces::grow(MeshFinding& finding, const Kept& defect) const {
  const auto at = [&](std::uint32_t v) { return mesh_.vertices()[v]; };
  finding.count += defect.count;
  finding.length = std::max(finding.length, defect.length);
  finding.severity = std::max(finding.severity, defect.severity);
  for (std::uint32_t k = 0; k < defect.vertexCount; ++k)
    finding.box.add(at(vertices_[defect.firstVertex + k]));
  for (std::uint32_t k = 0; k < defect.edgeCount && finding.edges.size() < MeshFinding::kMaxShown; ++k) {
    const MeshEdge& e = mesh_.edges()[edges_[defect.firstEdge + k]];
    finding.edges.push_back({at(e.v0), at(e.v1)});
  }
  for (std::uint32_t k = 0; k < defect.triangleCount && finding.triangles.size() < MeshFinding::kMaxShown;
       ++k) {
    const Triangle& t = mesh_.triangles()[triangles_[defect.firstTriangle + k]];
    finding.triangles.push_back({at(t[0]), at(t[1]), at(t[2])});
  }
}

void FindingPlaces::finish(MeshCheck& check, FindingKind kind, bool isCut) const {
  FindingTotal& total = check.totals[static_cast<std::size_t>(kind)];
  total.isCut = total.isCut || isCut;
  if (defects_.empty()) return;
  const std::vector<std::uint32_t> place = placesOfDefects();
  const std::size_t places = 1U + *std::ranges::max_element(place);
  std::vector<std::uint64_t> counts(places, 0);
  for (std::size_t i = 0; i < defects_.size(); ++i)
    counts[place[i]] += defects_[i].count;
  total.places += places;
  total.count += std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  std::vector<std::uint32_t> order(places), rankOf(places);
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, std::greater<>(), [&](std::uint32_t i) { return counts[i]; });
  for (std::uint32_t rank = 0; rank < places; ++rank)
    rankOf[order[rank]] = rank;
  std::vector<MeshFinding> findings(std::min(places, MeshCheck::kMaxPlaces));
  for (std::size_t i = 0; i < defects_.size(); ++i) {
    const std::uint32_t rank = rankOf[place[i]];
    if (rank >= findings.size()) continue;
    grow(findings[rank], defects_[i]);
  }
  for (MeshFinding& finding : findings) {
    finding.kind = kind;
    finding.point = pointOf(finding);
    check.findings.push_back(std::move(finding));
  }
}

}  // namespace nearfit
