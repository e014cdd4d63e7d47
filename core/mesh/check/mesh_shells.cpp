#include "core/mesh/check/mesh_shells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "core/exact/triangle_predicates.h"

namespace nearfit {
namespace {

constexpr std::uint32_t kNoShell = std::numeric_limits<std::uint32_t>::max();
/// A shell with less volume than this fraction of the mesh's diagonal cubed is a sheet: its volume is rounding.
constexpr double kLeastShellVolume = 1e-14;
/// Max triangles looked at to find which shells lie within others, and pairs of shells: about a second.
constexpr std::uint64_t kMaxRayWork = 300'000'000;
/// Max triangles of a shell that are looked at to find whether it lies within another.
constexpr std::size_t kMaxSamplesOfShell = 8;
/// How far behind the mesh's box rays end, in its diagonals.
constexpr double kRayReach = 2.0;

void numberShells(const TriangleMesh& mesh, MeshShells& result) {
  std::vector<std::uint32_t>& shellOf = result.shellOf;
  shellOf.assign(mesh.triangles().size(), kNoShell);
  std::vector<std::uint32_t> open;
  for (std::uint32_t first = 0; first < shellOf.size(); ++first) {
    if (shellOf[first] != kNoShell) continue;
    const auto number = static_cast<std::uint32_t>(result.shells.size());
    MeshShell& shell = result.shells.emplace_back();
    shell.firstTriangle = first;
    const auto reach = [&](std::uint32_t triangle) {
      if (shellOf[triangle] != kNoShell) return;
      shellOf[triangle] = number;
      open.push_back(triangle);
    };
    reach(first);
    while (!open.empty()) {
      const std::uint32_t triangle = open.back();
      open.pop_back();
      ++shell.triangles;
      for (const std::uint32_t edge : mesh.edgesOfTriangle(triangle)) {
        // A non-manifold edge may have very many faces: only its first face visits the others.
        const auto faces = mesh.facesOfEdge(edge);
        if (faces.size() > 2 && faces[0] != triangle) {
          reach(faces[0]);
        } else {
          for (const std::uint32_t face : faces)
            reach(face);
        }
      }
    }
  }
}

void measureShells(const TriangleMesh& mesh, MeshShells& result) {
  for (std::uint32_t i = 0; i < result.shellOf.size(); ++i) {
    MeshShell& shell = result.shells[result.shellOf[i]];
    for (const std::uint32_t v : mesh.triangles()[i])
      shell.box.add(mesh.vertices()[v]);
    for (const std::uint32_t edge : mesh.edgesOfTriangle(i))
      shell.isSolid = shell.isSolid && mesh.isEdgeConsistent(edge);
  }
  for (std::uint32_t i = 0; i < result.shellOf.size(); ++i) {
    MeshShell& shell = result.shells[result.shellOf[i]];
    const Triangle& t = mesh.triangles()[i];
    const glm::dvec3 centre = shell.box.centre();
    const glm::dvec3 a = mesh.vertices()[t[0]] - centre, b = mesh.vertices()[t[1]] - centre,
                     c = mesh.vertices()[t[2]] - centre;
    shell.volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  for (MeshShell& shell : result.shells) {
    const double diagonal = shell.box.diagonal();
    shell.isSolid =
        shell.isSolid && std::abs(shell.volume) > kLeastShellVolume * diagonal * diagonal * diagonal;
    if (!shell.isSolid) shell.volume = 0.0;
  }
}

bool holds(const Aabb& outer, const Aabb& inner) {
  return glm::all(glm::lessThanEqual(outer.lower, inner.lower)) &&
         glm::all(glm::greaterThanEqual(outer.upper, inner.upper));
}

class ShellNesting {
 public:
  ShellNesting(const TriangleMesh& mesh, MeshShells& result) : mesh_(mesh), result_(result) {
    for (std::uint32_t i = 0; i < result.shells.size(); ++i) {
      if (result.shells[i].isSolid) solid_.push_back(i);
    }
    if (solid_.size() > 1) sortTriangles();
  }

  void find() {
    if (solid_.size() < 2) return;
    // With the largest first, those that can hold a shell come before it.
    std::ranges::stable_sort(solid_, std::greater<>(),
                             [this](std::uint32_t i) { return result_.shells[i].box.diagonal(); });
    for (std::size_t k = 1; k < solid_.size(); ++k) {
      MeshShell& inner = result_.shells[solid_[k]];
      for (std::size_t other = 0; other < k; ++other) {
        const MeshShell& outer = result_.shells[solid_[other]];
        if (++work_ > kMaxRayWork) return leaveFrom(k);
        if (holds(outer.box, inner.box) && areSamplesWithin(solid_[k], solid_[other])) ++inner.depth;
      }
    }
  }

 private:
  /// Takes the shells that are not compared yet to face the right way.
  void leaveFrom(std::size_t k) {
    result_.isDepthExact = false;
    for (const std::uint32_t i : std::span(solid_).subspan(k))
      result_.shells[i].depth = result_.shells[i].volume > 0.0 ? 0 : 1;
  }

  void sortTriangles() {
    first_.assign(result_.shells.size() + 1, 0);
    for (const std::uint32_t shell : result_.shellOf)
      ++first_[shell + 1];
    for (std::size_t i = 1; i < first_.size(); ++i)
      first_[i] += first_[i - 1];
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    order_.resize(result_.shellOf.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i)
      order_[next[result_.shellOf[i]]++] = i;
  }

  TriangleCorners cornersAt(std::uint32_t triangle) const {
    const Triangle& t = mesh_.triangles()[triangle];
    return {mesh_.vertices()[t[0]], mesh_.vertices()[t[1]], mesh_.vertices()[t[2]]};
  }

  /// Some triangles spread over a shell stand for it: of shells that cross, some are outside.
  bool areSamplesWithin(std::uint32_t inner, std::uint32_t outer) {
    const std::size_t count = first_[inner + 1] - first_[inner];
    const std::size_t stride = 1 + (count - 1) / kMaxSamplesOfShell;
    for (std::size_t i = 0; i < count; i += stride) {
      if (!isWithin(order_[first_[inner] + i], outer)) return false;
    }
    return true;
  }

  bool isWithin(std::uint32_t triangle, std::uint32_t outer) {
    const TriangleCorners corners = cornersAt(triangle);
    const glm::dvec3 from = (corners[0] + corners[1] + corners[2]) / 3.0;
    const double reach = kRayReach * mesh_.bounds().diagonal();
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {1.0, -1.0}) {
        glm::dvec3 to = from;
        to[axis] += sign * reach;
        if (const std::optional<bool> answer = isOddAlong(from, to, axis, outer)) return *answer;
      }
    }
    // Each ray runs through an edge: what lies in the box counts.
    return true;
  }

  /// Nullopt if the ray runs through an edge or corner.
  std::optional<bool> isOddAlong(const glm::dvec3& from, const glm::dvec3& to, int axis,
                                 std::uint32_t outer) {
    bool isOdd = false;
    for (std::size_t i = first_[outer]; i < first_[outer + 1]; ++i) {
      ++work_;
      const TriangleCorners corners = cornersAt(order_[i]);
      if (isBeside(corners, from, axis)) continue;
      switch (crossingOf(from, to, corners)) {
        case Crossing::Unclear:
          return std::nullopt;
        case Crossing::Out:
        case Crossing::In:
          isOdd = !isOdd;
          break;
        case Crossing::None:
          break;
      }
    }
    return isOdd;
  }

  /// True if the triangle's box, seen along the axis, does not hold the point.
  static bool isBeside(const TriangleCorners& corners, const glm::dvec3& point, int axis) {
    for (const int across : {(axis + 1) % 3, (axis + 2) % 3}) {
      const auto [least, most] = std::minmax({corners[0][across], corners[1][across], corners[2][across]});
      if (point[across] < least || point[across] > most) return true;
    }
    return false;
  }

  const TriangleMesh& mesh_;
  MeshShells& result_;
  std::vector<std::uint32_t> solid_, order_;
  std::vector<std::size_t> first_;  ///< Place in order_ of each shell's triangles; then the total.
  std::uint64_t work_ = 0;
};

}  // namespace

MeshShells shellsOf(const TriangleMesh& mesh) {
  MeshShells result;
  numberShells(mesh, result);
  measureShells(mesh, result);
  ShellNesting(mesh, result).find();
  return result;
}

}  // namespace nearfit
