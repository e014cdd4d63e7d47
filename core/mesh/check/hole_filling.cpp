#include <algorithm>
#include <array>
#include <optional>
#include <unordered_set>
#include <utility>

#include "core/exact/hole_triangulation.h"
#include "core/mesh/check/border_loops.h"
#include "core/mesh/check/repair_steps.h"

namespace nearfit {
namespace {

std::uint64_t keyOfEdge(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

class HoleFiller {
 public:
  explicit HoleFiller(MeshInRepair& mesh) : mesh_(mesh), before_(mesh.built()) {}

  RepairStep fill(double size, const std::function<void(double)>& report) {
    RepairStep step;
    const std::vector<BorderLoop> loops = borderLoopsOf(before_);
    for (std::size_t i = 0; i < loops.size(); ++i) {
      report(static_cast<double>(i) / static_cast<double>(loops.size()));
      if (!loops[i].isClosed || boxOf(loops[i]).diagonal() > size) continue;
      const std::size_t faces = mesh_.triangles.size();
      if (fillOne(loops[i]))
        ++step.changed;
      else
        ++step.left;
      step.addedFaces += mesh_.triangles.size() - faces;
    }
    return step;
  }

 private:
  Aabb boxOf(const BorderLoop& loop) const {
    Aabb box;
    for (const std::uint32_t v : loop.vertices)
      box.add(before_.vertices()[v]);
    return box;
  }

  bool fillOne(const BorderLoop& loop) {
    // Faces beyond the border run along it, those of the fill against it.
    std::vector<std::uint32_t> rim(loop.vertices.rbegin(), loop.vertices.rend());
    if (rim.size() > kMaxHoleCorners) return false;
    std::vector<Triangle> faces = triangulated(rim);
    if (faces.empty() || !isNew(rim, faces)) faces = fanned(rim);
    if (repeatsNeighbour(rim, faces)) return false;
    for (const Triangle& face : faces) {
      mesh_.triangles.push_back(face);
      mesh_.originOf.push_back(RepairedMesh::kNoOrigin);
      for (std::size_t k = 0; k < 3; ++k)
        added_.insert(keyOfEdge(face[k], face[(k + 1) % 3]));
    }
    return true;
  }

  std::vector<Triangle> triangulated(const std::vector<std::uint32_t>& rim) const {
    std::vector<glm::dvec3> corners;
    corners.reserve(rim.size());
    for (const std::uint32_t v : rim)
      corners.push_back(before_.vertices()[v]);
    std::vector<Triangle> faces = triangulateHole(corners);
    for (Triangle& face : faces) {
      for (std::uint32_t& v : face)
        v = rim[v];
    }
    return faces;
  }

  /// True if no edge within the hole is one of the mesh or of another fill, where three faces would meet.
  bool isNew(const std::vector<std::uint32_t>& rim, const std::vector<Triangle>& faces) const {
    std::unordered_set<std::uint64_t> border;
    for (std::size_t i = 0; i < rim.size(); ++i)
      border.insert(keyOfEdge(rim[i], rim[(i + 1) % rim.size()]));
    return std::ranges::all_of(faces, [&](const Triangle& face) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = face[k], to = face[(k + 1) % 3];
        const std::uint64_t key = keyOfEdge(from, to);
        if (!border.contains(key) && (added_.contains(key) || edgeBetween(from, to))) return false;
      }
      return true;
    });
  }

  std::optional<std::uint32_t> edgeBetween(std::uint32_t a, std::uint32_t b) const {
    for (const std::uint32_t e : before_.edgesOfVertex(a)) {
      const MeshEdge& edge = before_.edges()[e];
      if (edge.v0 == b || edge.v1 == b) return e;
    }
    return std::nullopt;
  }

  /// True if a face has the corners of the one beyond the border: the hole is the outside of a single triangle.
  bool repeatsNeighbour(const std::vector<std::uint32_t>& rim, const std::vector<Triangle>& faces) const {
    if (rim.size() != 3 || faces.size() != 1) return false;
    const std::optional<std::uint32_t> edge = edgeBetween(rim[0], rim[1]);
    return edge && std::ranges::any_of(before_.facesOfEdge(*edge), [&](std::uint32_t face) {
             return std::ranges::is_permutation(before_.triangles()[face], faces.front());
           });
  }

  /// Triangles about a new vertex in the middle.
  std::vector<Triangle> fanned(const std::vector<std::uint32_t>& rim) {
    glm::dvec3 sum(0.0);
    for (const std::uint32_t v : rim)
      sum += before_.vertices()[v];
    const auto middle = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(sum / static_cast<double>(rim.size()));
    std::vector<Triangle> faces;
    faces.reserve(rim.size());
    for (std::size_t i = 0; i < rim.size(); ++i)
      faces.push_back({rim[i], rim[(i + 1) % rim.size()], middle});
    return faces;
  }

  MeshInRepair& mesh_;
  const TriangleMesh before_;
  std::unordered_set<std::uint64_t> added_;  ///< Edges of fills.
};

}  // namespace

RepairStep fillHoles(MeshInRepair& mesh, double size, const ProgressCallback& progress) {
  return HoleFiller(mesh).fill(size, stageOf(progress, 0.0, 1.0));
}

}  // namespace nearfit
