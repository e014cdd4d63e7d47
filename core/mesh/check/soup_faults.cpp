#include "core/mesh/check/soup_faults.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>

#include <glm/geometric.hpp>

#include "core/math/aabb.h"
#include "core/math/finite.h"
#include "core/math/mixed_bits.h"
#include "core/mesh/check/mesh_check.h"
#include "core/mesh/vertex_welding.h"

namespace nearfit {
namespace {

constexpr std::size_t kPolygonsPerReport = 65'536;

class SoupInspector {
 public:
  SoupInspector(const PolygonSoup& soup, const MeshBuildOptions& options) : soup_(soup) {
    vertices_.reserve(soup.vertices.size());
    Aabb box;
    for (const glm::dvec3& v : soup.vertices) {
      // One that is not finite is none of a face that counts, and must not spoil the box.
      vertices_.push_back(isFinite(v) ? options.metresPerUnit * v : glm::dvec3(0.0));
      if (isFinite(v)) box.add(vertices_.back());
    }
    representative_ = weldPoints(vertices_, options.weldTolerance * box.diagonal());
  }

  SoupFaults inspect(const std::function<void(double)>& report) {
    for (std::size_t i = 0; i < soup_.polygonCount(); ++i) {
      if (i % kPolygonsPerReport == 0)
        report(static_cast<double>(i) / static_cast<double>(soup_.polygonCount()));
      if (!isUsable(i)) continue;
      if (isDegenerate(i))
        keep(faults_.degenerate, i);
      else
        hashes_.emplace_back(hashOf(corners_), static_cast<std::uint32_t>(i));
    }
    std::ranges::sort(hashes_);
    for (std::size_t k = 1; k < hashes_.size(); ++k) {
      if (hashes_[k].first == hashes_[k - 1].first) keep(faults_.duplicate, hashes_[k].second);
    }
    return std::move(faults_);
  }

 private:
  std::span<const std::uint32_t> polygon(std::size_t i) const {
    return std::span(soup_.corners)
        .subspan(soup_.firstCorner[i], soup_.firstCorner[i + 1] - soup_.firstCorner[i]);
  }

  bool isUsable(std::size_t i) const {
    return !polygon(i).empty() && std::ranges::all_of(polygon(i), [&](std::uint32_t v) {
      return v < soup_.vertices.size() && isFinite(soup_.vertices[v]);
    });
  }

  /// Puts the welded corners into corners_.
  bool isDegenerate(std::size_t i) {
    corners_.clear();
    for (const std::uint32_t v : polygon(i)) {
      if (corners_.empty() || corners_.back() != representative_[v]) corners_.push_back(representative_[v]);
    }
    while (corners_.size() > 1 && corners_.front() == corners_.back())
      corners_.pop_back();
    if (corners_.size() < 3) return true;
    glm::dvec3 area(0.0);
    for (std::size_t k = 2; k < corners_.size(); ++k)
      area += glm::cross(at(k - 1) - at(0), at(k) - at(0));
    return area == glm::dvec3(0.0);
  }
  const glm::dvec3& at(std::size_t k) const { return vertices_[corners_[k]]; }

  static std::uint64_t hashOf(std::vector<std::uint32_t>& corners) {
    std::ranges::rotate(corners, std::ranges::min_element(corners));
    std::uint64_t hash = corners.size();
    for (const std::uint32_t v : corners)
      hash = mixedBits(hash ^ v);
    return hash;
  }

  void keep(std::vector<TriangleCorners>& faces, std::size_t i) const {
    if (faces.size() == MeshFinding::kMaxShown) return;
    const std::span<const std::uint32_t> corners = polygon(i);
    faces.push_back({vertices_[corners[0]], vertices_[corners[corners.size() / 3]],
                     vertices_[corners[2 * corners.size() / 3]]});
  }

  const PolygonSoup& soup_;
  std::vector<glm::dvec3> vertices_;  ///< [m]
  std::vector<std::uint32_t> representative_, corners_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> hashes_;  ///< Hash and index of polygons with an area.
  SoupFaults faults_;
};

}  // namespace

SoupFaults findSoupFaults(const PolygonSoup& soup, const MeshBuildOptions& options,
                          const ProgressCallback& progress) {
  return SoupInspector(soup, options).inspect(stageOf(progress, 0.0, 1.0));
}

}  // namespace nearfit
