#include "core/mesh/mesh_builder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/math/finite.h"
#include "core/mesh/coordinate_rounding.h"
#include "core/mesh/flat_triangles.h"
#include "core/mesh/polygon_triangulation.h"
#include "core/mesh/shell_orientation.h"
#include "core/mesh/t_junctions.h"
#include "core/mesh/vertex_welding.h"

namespace nearfit {
namespace {

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

/// Max coordinate [m]. Beyond it, the file is damaged or the unit wrong, and products of
/// lengths lose precision.
constexpr double kMaxExtent = 1e9;

void checkOptions(const MeshBuildOptions& options) {
  if (!std::isfinite(options.metresPerUnit) || !(options.metresPerUnit > 0.0)) {
    throw UsageError("unit", fmt::format("{} metres per unit is not a valid scale", options.metresPerUnit),
                     "give a finite number greater than 0");
  }
  if (!(options.weldTolerance >= 0.0) || options.weldTolerance > 0.1) {
    throw UsageError("weld tolerance",
                     fmt::format("{} of the diagonal is out of range", options.weldTolerance),
                     "give a number from 0 to 0.1");
  }
}

void checkSoup(const PolygonSoup& soup) {
  if (soup.vertices.size() > TriangleMesh::kMaxTriangles ||
      soup.polygonCount() > TriangleMesh::kMaxTriangles) {
    throw Error("", fmt::format("it has more than {} vertices or faces", TriangleMesh::kMaxTriangles),
                "reduce the mesh first");
  }
  if (soup.firstCorner.empty() || soup.firstCorner.front() != 0 ||
      soup.firstCorner.back() != soup.corners.size() || !std::ranges::is_sorted(soup.firstCorner)) {
    throw Error("", "its list of faces is inconsistent", "export the part again");
  }
  for (std::size_t i = 0; i < soup.polygonCount(); ++i) {
    for (std::uint32_t k = soup.firstCorner[i]; k < soup.firstCorner[i + 1]; ++k) {
      if (soup.corners[k] < soup.vertices.size()) continue;
      throw Error(fmt::format("face {}", i),
                  fmt::format("it refers to vertex {} of {}", soup.corners[k], soup.vertices.size()),
                  "export the part again");
    }
  }
}

/// The steps of buildMesh().
class Builder {
 public:
  Builder(const PolygonSoup& soup, const MeshBuildOptions& options, MeshBuildReport& report,
          const std::function<void(double)>& onProgress, std::vector<std::uint32_t>* polygonOf)
      : soup_(soup), options_(options), report_(report), onProgress_(onProgress), polygonOf_(polygonOf) {
    if (polygonOf_ != nullptr) polygonOf_->clear();
  }

  TriangleMesh build() {
    gatherVertices();
    report(0.1);
    weld();
    report(0.3);
    gatherTriangles();
    report(0.4);
    dropDuplicates();
    report(0.5);
    report_.swappedFaces = swapFlatTriangles(vertices_, triangles_, tolerance_, polygonOf_);
    dropTrianglesWithoutArea();
    if (triangles_.empty()) throw Error("", "none of its faces has an area", "export the part again");
    dropUnusedVertices();
    report(0.6);
    return {std::move(vertices_), std::move(triangles_)};
  }

 private:
  /// Fractions match the time that an ordinary mesh takes.
  void report(double fraction) const {
    if (onProgress_) onProgress_(fraction);
  }
  std::span<const std::uint32_t> polygon(std::size_t i) const {
    return std::span(soup_.corners)
        .subspan(soup_.firstCorner[i], soup_.firstCorner[i + 1] - soup_.firstCorner[i]);
  }
  bool isFinitePolygon(std::span<const std::uint32_t> corners) const {
    return std::ranges::all_of(
        corners, [&](std::uint32_t v) { return isFinite(options_.metresPerUnit * soup_.vertices[v]); });
  }

  /// Takes only vertices that faces use, in metres: others must not affect the bounding box.
  void gatherVertices() {
    newIndex_.assign(soup_.vertices.size(), kNoVertex);
    Aabb box;
    for (std::size_t i = 0; i < soup_.polygonCount(); ++i) {
      if (!isFinitePolygon(polygon(i))) continue;
      for (const std::uint32_t v : polygon(i)) {
        if (newIndex_[v] != kNoVertex) continue;
        newIndex_[v] = static_cast<std::uint32_t>(vertices_.size());
        vertices_.push_back(options_.metresPerUnit * soup_.vertices[v]);
        box.add(vertices_.back());
      }
    }
    if (vertices_.empty())
      throw Error("", "none of its faces has finite coordinates", "export the part again");
    const glm::dvec3 reach = glm::max(glm::abs(box.lower), glm::abs(box.upper));
    if (const double farthest = std::max({reach.x, reach.y, reach.z}); farthest > kMaxExtent) {
      throw Error("", fmt::format("a coordinate is too far from the origin: {:.3g} m", farthest),
                  "check the unit, or export the part again");
    }
    tolerance_ = options_.weldTolerance * box.diagonal();
  }

  void weld() {
    const std::vector<std::uint32_t> representative = weldPoints(vertices_, tolerance_);
    for (std::uint32_t& index : newIndex_) {
      if (index != kNoVertex) index = representative[index];
    }
    for (std::uint32_t i = 0; i < representative.size(); ++i)
      report_.weldedVertices += representative[i] != i ? 1 : 0;
  }

  void gatherTriangles() {
    PolygonTriangulator triangulator;
    std::vector<std::uint32_t> corners;
    triangles_.reserve(soup_.polygonCount());
    for (std::size_t i = 0; i < soup_.polygonCount(); ++i) {
      if (!isFinitePolygon(polygon(i))) {
        ++report_.nonFiniteFaces;
        continue;
      }
      corners.clear();
      for (const std::uint32_t v : polygon(i)) {
        if (corners.empty() || corners.back() != newIndex_[v]) corners.push_back(newIndex_[v]);
      }
      while (corners.size() > 1 && corners.front() == corners.back())
        corners.pop_back();
      const bool isUsable =
          corners.size() >= 3 && triangulator.triangulate(vertices_, corners, triangles_) > 0;
      report_.degenerateFaces += isUsable ? 0 : 1;
      if (polygonOf_ != nullptr) polygonOf_->resize(triangles_.size(), static_cast<std::uint32_t>(i));
    }
    newIndex_ = {};
  }

  void dropTrianglesWithoutArea() {
    const std::size_t before = triangles_.size();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < before; ++i) {
      const Triangle t = triangles_[i];
      const glm::dvec3 a = vertices_[t[0]], b = vertices_[t[1]], c = vertices_[t[2]];
      if (glm::cross(b - a, c - a) != glm::dvec3(0.0)) keep(i, kept++);
    }
    cutTo(kept);
    report_.degenerateFaces += before - kept;
  }

  void dropDuplicates() {
    std::vector<std::uint32_t> slots(std::bit_ceil(2 * triangles_.size() + 1), kNoVertex);
    const std::size_t before = triangles_.size();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < before; ++i) {
      const Triangle t = triangles_[i];
      std::size_t slot = slotOf(t) & (slots.size() - 1);
      while (slots[slot] != kNoVertex && startingAtLowest(triangles_[slots[slot]]) != startingAtLowest(t)) {
        slot = (slot + 1) & (slots.size() - 1);
      }
      if (slots[slot] != kNoVertex) continue;
      slots[slot] = static_cast<std::uint32_t>(kept);
      keep(i, kept++);
    }
    report_.duplicateFaces = before - kept;
    cutTo(kept);
  }
  /// Moves triangle `from` to place `to`, at or before its own.
  void keep(std::size_t from, std::size_t to) {
    triangles_[to] = triangles_[from];
    if (polygonOf_ != nullptr) (*polygonOf_)[to] = (*polygonOf_)[from];
  }
  void cutTo(std::size_t count) {
    triangles_.resize(count);
    if (polygonOf_ != nullptr) polygonOf_->resize(count);
  }
  static Triangle startingAtLowest(Triangle t) {
    std::ranges::rotate(t, std::ranges::min_element(t));
    return t;
  }
  static std::uint64_t slotOf(const Triangle& t) {
    std::uint64_t h = 0;
    for (const std::uint32_t v : startingAtLowest(t)) {
      h = (h ^ v) * 0x9E3779B97F4A7C15U;
      h ^= h >> 32;
    }
    return h;
  }

  void dropUnusedVertices() {
    std::vector<std::uint32_t> index(vertices_.size(), kNoVertex);
    std::vector<glm::dvec3> used;
    used.reserve(vertices_.size() - report_.weldedVertices);
    for (Triangle& t : triangles_) {
      for (std::uint32_t& v : t) {
        if (index[v] == kNoVertex) {
          index[v] = static_cast<std::uint32_t>(used.size());
          used.push_back(vertices_[v]);
        }
        v = index[v];
      }
    }
    vertices_ = std::move(used);
  }

  const PolygonSoup& soup_;
  const MeshBuildOptions& options_;
  MeshBuildReport& report_;
  const std::function<void(double)>& onProgress_;
  std::vector<std::uint32_t>* polygonOf_;  ///< By triangle; may be null.
  double tolerance_ = 0.0;                 ///< [m]
  std::vector<glm::dvec3> vertices_;       ///< [m]
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> newIndex_;  ///< By vertex of the soup.
};

/// "1 edge is", "2 edges are"
std::string counted(std::uint64_t count, std::string_view noun, std::string_view singular,
                    std::string_view plural) {
  return fmt::format("{} {}{} {}", count, noun, count == 1 ? "" : "s", count == 1 ? singular : plural);
}

void addWarnings(MeshBuildReport& report) {
  const auto warn = [&](std::uint64_t count, std::string_view noun, std::string_view singular,
                        std::string_view plural) {
    if (count > 0) report.warnings.push_back(counted(count, noun, singular, plural));
  };
  warn(report.nonFiniteFaces, "face", "has coordinates that are not finite and was left out.",
       "have coordinates that are not finite and were left out.");
  warn(report.degenerateFaces, "face", "has no area and was left out.", "have no area and were left out.");
  warn(report.duplicateFaces, "face", "repeats another and was left out.",
       "repeat others and were left out.");
  warn(report.stitchedEdges, "edge",
       "was cracked (vertices of one face on the edge of another) and was stitched.",
       "were cracked (vertices of one face on the edge of another) and were stitched.");
}

/// Closes cracks. Most meshes have none and are not rebuilt.
TriangleMesh stitched(TriangleMesh mesh, MeshBuildReport& report, std::vector<std::uint32_t>* polygonOf) {
  std::vector<std::uint32_t> origins;
  std::vector<Triangle> triangles = stitchTJunctions(mesh, polygonOf != nullptr ? &origins : nullptr);
  if (triangles.empty()) return mesh;
  if (polygonOf != nullptr) {
    for (std::uint32_t& origin : origins)
      origin = (*polygonOf)[origin];
    *polygonOf = std::move(origins);
  }
  const std::uint32_t before = mesh.topology().openEdges;
  mesh = {{mesh.vertices().begin(), mesh.vertices().end()}, std::move(triangles)};
  report.stitchedEdges = before - mesh.topology().openEdges;
  return mesh;
}

/// Flips what is inside out. Most meshes need no flip and are not rebuilt.
TriangleMesh outsideOut(TriangleMesh mesh, MeshBuildReport& report) {
  OrientedShells shells = orientShells(mesh);
  if (shells.turnedPieces == 0) return mesh;
  report.turnedInsideOut = true;
  report.warnings.push_back(shells.closedPieces == 1
                                ? "The mesh was inside out; its faces were flipped."
                                : fmt::format("{} of {} closed components {} inside out and flipped.",
                                              shells.turnedPieces, shells.closedPieces,
                                              shells.turnedPieces == 1 ? "was" : "were"));
  return {{mesh.vertices().begin(), mesh.vertices().end()}, std::move(shells.triangles)};
}

}  // namespace

void PolygonSoup::closePolygon() {
  if (corners.size() >= kNoVertex)
    throw Error("", "its faces have too many corners", "reduce the mesh first");
  firstCorner.push_back(static_cast<std::uint32_t>(corners.size()));
}

std::vector<std::string> topologyWarnings(const MeshTopology& topology) {
  std::vector<std::string> warnings;
  const auto warn = [&](std::uint64_t count, std::string_view singular, std::string_view plural) {
    if (count > 0) warnings.push_back(counted(count, "edge", singular, plural));
  };
  warn(topology.openEdges, "is open (one face only).", "are open (one face only).");
  warn(topology.nonManifoldEdges, "is non-manifold (three faces or more).",
       "are non-manifold (three faces or more).");
  warn(topology.inconsistentEdges, "is inconsistent (its two faces have opposite senses).",
       "are inconsistent (their two faces have opposite senses).");
  return warnings;
}

MeshCondition conditionOf(const TriangleMesh& mesh, const MeshBuildReport& report) {
  if (report.warnings.empty()) return MeshCondition::Sound;
  if (!topologyWarnings(mesh.topology()).empty()) return MeshCondition::Open;
  // One sentence each, as buildMesh() adds them; readers add theirs.
  const auto mended = std::ranges::count_if(
      std::array{report.nonFiniteFaces > 0, report.degenerateFaces > 0, report.duplicateFaces > 0,
                 report.stitchedEdges > 0, report.turnedInsideOut},
      std::identity());
  return std::cmp_greater(report.warnings.size(), mended) ? MeshCondition::Doubtful : MeshCondition::Mended;
}

TriangleMesh buildMesh(const PolygonSoup& soup, const MeshBuildOptions& options, MeshBuildReport& report,
                       const std::function<void(double)>& onProgress,
                       std::vector<std::uint32_t>* polygonOfTriangle) {
  checkOptions(options);
  checkSoup(soup);
  report = {};
  report.coordinateRounding = options.metresPerUnit * coordinateRounding(soup.vertices);
  TriangleMesh mesh = stitched(Builder(soup, options, report, onProgress, polygonOfTriangle).build(), report,
                               polygonOfTriangle);
  addWarnings(report);
  const std::vector<std::string> defects = topologyWarnings(mesh.topology());
  report.warnings.insert(report.warnings.end(), defects.begin(), defects.end());
  return outsideOut(std::move(mesh), report);
}

}  // namespace nearfit
