#include "core/mesh/check/repair_steps.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "core/mesh/check/face_faults.h"
#include "core/mesh/check/mesh_shells.h"
#include "core/mesh/flat_triangles.h"
#include "core/mesh/t_junctions.h"
#include "core/mesh/vertex_welding.h"

namespace nearfit {
namespace {

/// Max rounds of taking back merges that would swallow a face. Two or three are common.
constexpr int kMaxRoundsBack = 32;

bool usesTwice(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

Triangle replaced(Triangle t, const std::vector<std::uint32_t>& by) {
  for (std::uint32_t& v : t)
    v = by[v];
  return t;
}

/// Vertices of open edges, ascending.
std::vector<std::uint32_t> rimOf(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> rim;
  for (std::uint32_t e = 0; e < mesh.edges().size(); ++e) {
    if (mesh.facesOfEdge(e).size() == 1) rim.insert(rim.end(), {mesh.edges()[e].v0, mesh.edges()[e].v1});
  }
  std::ranges::sort(rim);
  rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
  return rim;
}

/// Takes back merges that would make a face use a vertex twice.
void keepFaces(const std::vector<Triangle>& triangles, std::vector<std::uint32_t>& by) {
  bool isSettled = false;
  for (int round = 0; round < kMaxRoundsBack && !isSettled; ++round) {
    isSettled = true;
    for (const Triangle& t : triangles) {
      if (!usesTwice(replaced(t, by))) continue;
      for (const std::uint32_t v : t)
        by[v] = v;
      isSettled = false;
    }
  }
}

/// By vertex: the one that it is merged into.
std::vector<std::uint32_t> mergesOfRims(const MeshInRepair& mesh, double tolerance) {
  const std::vector<std::uint32_t> rim = rimOf(mesh.built());
  std::vector<glm::dvec3> points;
  points.reserve(rim.size());
  for (const std::uint32_t v : rim)
    points.push_back(mesh.vertices[v]);
  std::vector<std::uint32_t> by(mesh.vertices.size());
  std::iota(by.begin(), by.end(), 0U);
  if (points.empty()) return by;
  const std::vector<std::uint32_t> representative = weldPoints(points, tolerance);
  for (std::size_t i = 0; i < rim.size(); ++i)
    by[rim[i]] = rim[representative[i]];
  keepFaces(mesh.triangles, by);
  return by;
}

std::uint64_t mergedIn(const std::vector<std::uint32_t>& by) {
  std::uint64_t merged = 0;
  for (std::uint32_t v = 0; v < by.size(); ++v)
    merged += by[v] != v ? 1 : 0;
  return merged;
}

RepairStep removeCopies(MeshInRepair& mesh) {
  RepairStep step;
  const std::vector<FaceCopies> groups = copiesOfFaces(mesh.built());
  std::vector<bool> isRemoved(mesh.triangles.size(), false);
  for (const FaceCopies& copies : groups) {
    for (const std::uint32_t face : copies.surplus)
      isRemoved[face] = true;
    if (copies.areOpposite && copies.surplus.size() == copies.faces.size())
      step.wallFaces += copies.surplus.size();
  }
  step.removedFaces = mesh.remove(isRemoved);
  return step;
}

/// Closes T-junctions up to a width; returns the number of faces added.
std::uint64_t splitAtVertices(MeshInRepair& mesh, double reach) {
  std::vector<std::uint32_t> origins;
  std::vector<Triangle> fragments = stitchTJunctions(mesh.built(), reach, origins);
  if (fragments.empty()) return 0;
  const std::uint64_t added = fragments.size() - mesh.triangles.size();
  mesh.replaceByFragments(std::move(fragments), origins);
  return added;
}

/// Makes the faces of each patch (faces connected through edges of two faces) agree with the most of them.
class PatchOrienter {
 public:
  explicit PatchOrienter(const TriangleMesh& mesh) : mesh_(mesh), isTurned_(mesh.triangles().size(), false) {}

  std::vector<bool> run() {
    std::vector<bool> isReached(mesh_.triangles().size(), false);
    std::vector<std::uint32_t> patch;
    for (std::uint32_t first = 0; first < isReached.size(); ++first) {
      if (isReached[first]) continue;
      patch.assign(1, first);
      isReached[first] = true;
      std::size_t turned = 0;
      for (std::size_t i = 0; i < patch.size(); ++i)
        turned += reachFrom(patch[i], patch, isReached);
      if (2 * turned > patch.size()) {
        for (const std::uint32_t triangle : patch)
          isTurned_[triangle] = !isTurned_[triangle];
      }
    }
    return std::move(isTurned_);
  }

 private:
  /// Reaches the neighbours of a face; returns how many of them it turns.
  std::size_t reachFrom(std::uint32_t triangle, std::vector<std::uint32_t>& patch,
                        std::vector<bool>& isReached) {
    std::size_t turned = 0;
    for (const std::uint32_t edge : mesh_.edgesOfTriangle(triangle)) {
      const auto faces = mesh_.facesOfEdge(edge);
      if (faces.size() != 2) continue;
      const std::uint32_t other = faces[0] == triangle ? faces[1] : faces[0];
      if (isReached[other]) continue;
      isReached[other] = true;
      isTurned_[other] = isTurned_[triangle] == mesh_.isEdgeConsistent(edge);
      turned += isTurned_[other] ? 1 : 0;
      patch.push_back(other);
    }
    return turned;
  }

  const TriangleMesh& mesh_;
  std::vector<bool> isTurned_;
};

void turnFaces(std::vector<Triangle>& triangles, const std::vector<bool>& isTurned) {
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (isTurned[i]) std::swap(triangles[i][1], triangles[i][2]);
  }
}

}  // namespace

MeshInRepair::MeshInRepair(const TriangleMesh& mesh)
    : vertices(mesh.vertices().begin(), mesh.vertices().end()),
      triangles(mesh.triangles().begin(), mesh.triangles().end()),
      originOf(mesh.triangles().size()) {
  std::iota(originOf.begin(), originOf.end(), 0U);
}

std::uint64_t MeshInRepair::replaceCorners(const std::vector<std::uint32_t>& by) {
  std::vector<bool> isRemoved(triangles.size(), false);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    triangles[i] = replaced(triangles[i], by);
    isRemoved[i] = usesTwice(triangles[i]);
  }
  return remove(isRemoved);
}

std::uint64_t MeshInRepair::remove(const std::vector<bool>& isRemoved) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (isRemoved[i]) continue;
    triangles[kept] = triangles[i];
    originOf[kept++] = originOf[i];
  }
  const std::uint64_t removed = triangles.size() - kept;
  triangles.resize(kept);
  originOf.resize(kept);
  return removed;
}

void MeshInRepair::replaceByFragments(std::vector<Triangle> fragments,
                                      const std::vector<std::uint32_t>& origins) {
  std::vector<std::uint32_t> fromStart;
  fromStart.reserve(origins.size());
  for (const std::uint32_t origin : origins)
    fromStart.push_back(originOf[origin]);
  triangles = std::move(fragments);
  originOf = std::move(fromStart);
}

RepairStep weldVertices(MeshInRepair& mesh, double tolerance) {
  RepairStep step;
  const std::vector<std::uint32_t> by = weldPoints(mesh.vertices, tolerance);
  step.changed = mergedIn(by);
  if (step.changed > 0) step.removedFaces = mesh.replaceCorners(by);
  return step;
}

RepairStep stitchBorders(MeshInRepair& mesh, double tolerance) {
  RepairStep step;
  const std::vector<std::uint32_t> by = mergesOfRims(mesh, tolerance);
  step.changed = mergedIn(by);
  if (step.changed > 0) step.removedFaces = mesh.replaceCorners(by);
  if (!mesh.triangles.empty()) step.addedFaces = splitAtVertices(mesh, tolerance);
  return step;
}

RepairStep cleanFaces(MeshInRepair& mesh) {
  RepairStep step = removeCopies(mesh);
  const TriangleMesh present = mesh.built();
  step.changed = swapFlatTriangles(mesh.vertices, mesh.triangles, kNoHeight * present.bounds().diagonal(),
                                   &mesh.originOf);
  std::vector<bool> isRemoved(mesh.triangles.size(), false);
  for (const std::uint32_t face : facesWithoutArea(mesh.built()))
    isRemoved[face] = true;
  const std::uint64_t flat = mesh.remove(isRemoved);
  step.removedFaces += flat;
  // A line that goes leaves a crack of no width.
  if (flat > 0 && !mesh.triangles.empty())
    step.addedFaces = splitAtVertices(mesh, kOnEdge * present.bounds().diagonal());
  return step;
}

RepairStep orientFaces(MeshInRepair& mesh) {
  RepairStep step;
  std::vector<bool> isTurned = PatchOrienter(mesh.built()).run();
  turnFaces(mesh.triangles, isTurned);
  const TriangleMesh agreeing = mesh.built();
  const MeshShells shells = shellsOf(agreeing);
  std::vector<bool> isInverted(mesh.triangles.size(), false);
  for (std::size_t i = 0; i < isInverted.size(); ++i) {
    isInverted[i] = shells.shells[shells.shellOf[i]].isInverted();
    isTurned[i] = isTurned[i] != isInverted[i];
  }
  turnFaces(mesh.triangles, isInverted);
  step.changed = static_cast<std::uint64_t>(std::ranges::count(isTurned, true));
  step.left = agreeing.topology().inconsistentEdges;
  return step;
}

RepairStep dropShells(MeshInRepair& mesh, double size) {
  RepairStep step;
  const MeshShells shells = shellsOf(mesh.built());
  std::vector<bool> isRemoved(mesh.triangles.size(), false);
  for (std::size_t i = 0; i < isRemoved.size(); ++i)
    isRemoved[i] = shells.shells[shells.shellOf[i]].box.diagonal() <= size;
  for (const MeshShell& shell : shells.shells)
    step.changed += shell.box.diagonal() <= size ? 1 : 0;
  step.removedFaces = mesh.remove(isRemoved);
  return step;
}

}  // namespace nearfit
