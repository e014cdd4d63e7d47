#include "core/path/swept_volume.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/math/aabb.h"
#include "core/parallel/parallel_for.h"
#include "core/parallel/shared_progress.h"
#include "core/path/path_bodies.h"
#include "core/report/scene_export.h"

namespace nearfit {
namespace {

const double kRoot3 = std::sqrt(3.0);
/// Share of the resolution by which a point may be from where a sampled pose has it.
constexpr double kMotionShare = 1.0 / 3.0;
/// Cell, as a share of the resolution E. A surface point is within E / 3 of where a sampled pose has it, that is within
/// h / sqrt(3) of a sample on the surface, that is within h sqrt(3) / 2 of its node. Linear interpolation of a distance
/// over a tetrahedron of the lattice is off by at most h sqrt(3) / 2. So the level E / 3 + h (1 / sqrt(3) + sqrt(3))
/// covers every point, and where it is reached a sample is within E / 3 + h (1 / sqrt(3) + 2 sqrt(3)) = E.
const double kCellShare = (1.0 - kMotionShare) / (1.0 / kRoot3 + 2.0 * kRoot3);
/// That level, in cells.
const double kLevel = kMotionShare / kCellShare + 1.0 / kRoot3 + kRoot3;
/// Distances are exact up to this many cells: the level, and the longest side of a tetrahedron beyond it.
constexpr int kReachCells = 7;
/// Marks nodes without a sample in reach. With the square of the reach added it still fits a byte, and squared distances
/// that are exact, at most three times that square, are below.
constexpr std::uint8_t kFarSquared = 200;
static_assert(kFarSquared + kReachCells * kReachCells < 256 && 3 * kReachCells * kReachCells < kFarSquared);

using NodeIndex = std::uint32_t;

/// Points on a part's surface, in its frame: none of its points is farther than the spacing over sqrt(3) from one.
std::vector<glm::dvec3> surfacePoints(const TriangleMesh& mesh, double spacing) {
  std::vector<glm::dvec3> points;
  for (const Triangle& t : mesh.triangles()) {
    const glm::dvec3 &a = mesh.vertices()[t[0]], &b = mesh.vertices()[t[1]], &c = mesh.vertices()[t[2]];
    const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    const auto steps = static_cast<std::size_t>(std::max(1.0, std::ceil(longest / spacing)));
    for (std::size_t i = 0; i <= steps; ++i) {
      for (std::size_t k = 0; k + i <= steps; ++k) {
        const double u = static_cast<double>(i) / static_cast<double>(steps),
                     v = static_cast<double>(k) / static_cast<double>(steps);
        points.push_back(a + u * (b - a) + v * (c - a));
      }
    }
  }
  return points;
}

/// Number of those points, but for vertices that triangles share.
double countOfPoints(const TriangleMesh& mesh, double spacing) {
  double count = 0.0;
  for (const Triangle& t : mesh.triangles()) {
    const glm::dvec3 &a = mesh.vertices()[t[0]], &b = mesh.vertices()[t[1]], &c = mesh.vertices()[t[2]];
    const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    const double steps = std::max(1.0, std::ceil(longest / spacing));
    count += 0.5 * (steps + 1.0) * (steps + 2.0);
  }
  return count;
}

/// Poses of a part between which no point of it moves farther than `apart`, to either side.
std::vector<RigidTransform> sampledPoses(const AssemblyPath& path, const PathPart& part, double apart) {
  const PathTravel travel(path, part);
  const double total = travel.at(path.end());
  const double steps = std::max(1.0, std::ceil(total / (2.0 * apart)));
  std::vector<RigidTransform> poses;
  for (double i = 0.0; i < steps; i += 1.0) {
    const double place = travel.placeAt(total * (i + 0.5) / steps, 0.0, path.end());
    poses.push_back(poseAt(path, place) * part.leadFromPart);
  }
  return poses;
}

/// Regular lattice of nodes with a byte each.
class SweptLattice {
 public:
  SweptLattice(const Aabb& box, double cell) : cell_(cell) {
    // Beyond the level there is room for a border that is outside.
    const double margin = (kReachCells + 2.0) * cell;
    origin_ = box.lower - glm::dvec3(margin);
    const glm::dvec3 extent = box.upper - box.lower + glm::dvec3(2.0 * margin);
    for (glm::length_t k = 0; k < 3; ++k)
      counts_[static_cast<std::size_t>(k)] = std::ceil(extent[k] / cell) + 1.0;
  }

  double nodes() const { return counts_[0] * counts_[1] * counts_[2]; }

  void allocate() {
    for (std::size_t k = 0; k < 3; ++k)
      size_[k] = static_cast<std::size_t>(counts_[k]);
    squared_.assign(size_[0] * size_[1] * size_[2], kFarSquared);
  }

  /// Marks the nearest node. Any thread.
  void mark(const glm::dvec3& point) {
    const glm::dvec3 at = glm::round((point - origin_) / cell_);
    std::array<std::size_t, 3> node{};
    for (std::size_t k = 0; k < 3; ++k) {
      // Clamped against rounding at the border alone.
      const double clamped = std::clamp(at[static_cast<glm::length_t>(k)], 0.0, counts_[k] - 1.0);
      node[k] = static_cast<std::size_t>(clamped);
    }
    std::atomic_ref(squared_[indexOf(node[0], node[1], node[2])]).store(0, std::memory_order_relaxed);
  }

  /// Replaces marks by squared distances to the nearest one [cells^2], axis by axis.
  void spread() {
    std::vector<std::uint8_t> next(squared_.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t stride = axis == 0 ? 1 : axis == 1 ? size_[0] : size_[0] * size_[1];
      // Rows along x, each at one y and z.
      parallelFor(size_[2], [&](std::size_t z) {
        for (std::size_t y = 0; y < size_[1]; ++y)
          spreadRow(axis, stride, y, z, next);
      });
      std::swap(squared_, next);
    }
  }

  /// Takes all that is not reached from the border without passing the level for inside.
  void fill() {
    std::vector<std::uint8_t> isReached(squared_.size(), 0);
    std::vector<NodeIndex> front{0}, next;
    isReached[0] = 1;
    while (!front.empty()) {
      next.clear();
      for (const NodeIndex node : front)
        reachFrom(node, isReached, next);
      std::swap(front, next);
    }
    for (std::size_t i = 0; i < squared_.size(); ++i) {
      if (isReached[i] == 0 && !isInside(squared_[i])) squared_[i] = 0;
    }
  }

  /// The level as a mesh, by marching tetrahedra.
  TriangleMesh surface(const std::function<void(double fraction)>& onSlab) {
    for (std::size_t z = 0; z + 1 < size_[2]; ++z) {
      for (std::size_t y = 0; y + 1 < size_[1]; ++y) {
        for (std::size_t x = 0; x + 1 < size_[0]; ++x)
          marchCube(indexOf(x, y, z));
      }
      onSlab(static_cast<double>(z) / static_cast<double>(size_[2]));
    }
    return {std::move(vertices_), std::move(triangles_)};
  }

 private:
  std::size_t indexOf(std::size_t x, std::size_t y, std::size_t z) const {
    return x + size_[0] * (y + size_[1] * z);
  }
  static double distanceOf(std::uint8_t squared) {
    return std::min(std::sqrt(static_cast<double>(squared)), static_cast<double>(kReachCells));
  }
  static bool isInside(std::uint8_t squared) { return squared <= kLevel * kLevel; }

  void spreadRow(std::size_t axis, std::size_t stride, std::size_t y, std::size_t z,
                 std::vector<std::uint8_t>& next) const {
    const std::size_t row = indexOf(0, y, z);
    for (std::size_t x = 0; x < size_[0]; ++x) {
      const std::array<std::size_t, 3> at{x, y, z};
      const std::size_t below = std::min<std::size_t>(kReachCells, at[axis]),
                        above = std::min<std::size_t>(kReachCells, size_[axis] - 1 - at[axis]);
      int least = squared_[row + x];
      for (std::size_t k = 1; k <= below; ++k)
        least = std::min(least, squared_[row + x - k * stride] + static_cast<int>(k * k));
      for (std::size_t k = 1; k <= above; ++k)
        least = std::min(least, squared_[row + x + k * stride] + static_cast<int>(k * k));
      next[row + x] = static_cast<std::uint8_t>(least);
    }
  }

  /// Visits the neighbours along edges of tetrahedra, so that no edge leads from what is reached to what is filled.
  void reachFrom(NodeIndex node, std::vector<std::uint8_t>& isReached, std::vector<NodeIndex>& next) const {
    const std::array<std::size_t, 3> at{node % size_[0], node / size_[0] % size_[1],
                                        node / (size_[0] * size_[1])};
    for (unsigned step = 1; step < 8; ++step) {
      std::size_t offset = 0, stride = 1;
      bool isAbove = true, isBelow = true;
      for (std::size_t k = 0; k < 3; ++k) {
        if ((step >> k & 1U) != 0) {
          offset += stride;
          isAbove = isAbove && at[k] + 1 < size_[k];
          isBelow = isBelow && at[k] > 0;
        }
        stride *= size_[k];
      }
      const auto visit = [&](std::size_t other) {
        if (isReached[other] != 0 || isInside(squared_[other])) return;
        isReached[other] = 1;
        next.push_back(static_cast<NodeIndex>(other));
      };
      if (isAbove) visit(node + offset);
      if (isBelow) visit(node - offset);
    }
  }

  void marchCube(std::size_t node) {
    // The corner whose bits are the offsets along x, y and z.
    std::array<std::size_t, 8> corners{};
    unsigned inside = 0;
    for (unsigned c = 0; c < 8; ++c) {
      corners[c] = node + ((c & 1U) != 0 ? 1 : 0) + ((c & 2U) != 0 ? size_[0] : 0) +
                   ((c & 4U) != 0 ? size_[0] * size_[1] : 0);
      inside += isInside(squared_[corners[c]]) ? 1 : 0;
    }
    if (inside == 0 || inside == 8) return;
    // Six tetrahedra about the diagonal, the same ones seen from each neighbour. The second and third corner are
    // swapped where needed, so that all are of one sense.
    constexpr std::array<std::array<unsigned, 4>, 6> kTetrahedra{
        {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}}};
    for (const auto& t : kTetrahedra)
      marchTetrahedron({corners[t[0]], corners[t[1]], corners[t[2]], corners[t[3]]});
  }

  void marchTetrahedron(const std::array<std::size_t, 4>& t) {
    unsigned mask = 0;
    for (unsigned i = 0; i < 4; ++i)
      mask |= isInside(squared_[t[i]]) ? 1U << i : 0U;
    // Even orders of the corners, so that the sense stays: those that are inside, or the one that differs, come first.
    const auto one = [&](std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
      addTriangle(crossing(t[i], t[j]), crossing(t[i], t[k]), crossing(t[i], t[l]));
    };
    const auto three = [&](std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
      addTriangle(crossing(t[i], t[j]), crossing(t[i], t[l]), crossing(t[i], t[k]));
    };
    const auto two = [&](std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
      const std::uint32_t ik = crossing(t[i], t[k]), il = crossing(t[i], t[l]), jk = crossing(t[j], t[k]),
                          jl = crossing(t[j], t[l]);
      addTriangle(ik, il, jl);
      addTriangle(ik, jl, jk);
    };
    switch (mask) {
      case 0b0001:
        return one(0, 1, 2, 3);
      case 0b0010:
        return one(1, 0, 3, 2);
      case 0b0100:
        return one(2, 3, 0, 1);
      case 0b1000:
        return one(3, 2, 1, 0);
      case 0b1110:
        return three(0, 1, 2, 3);
      case 0b1101:
        return three(1, 0, 3, 2);
      case 0b1011:
        return three(2, 3, 0, 1);
      case 0b0111:
        return three(3, 2, 1, 0);
      case 0b0011:
        return two(0, 1, 2, 3);
      case 0b0101:
        return two(0, 2, 3, 1);
      case 0b1001:
        return two(0, 3, 1, 2);
      case 0b0110:
        return two(1, 2, 0, 3);
      case 0b1010:
        return two(1, 3, 2, 0);
      case 0b1100:
        return two(2, 3, 0, 1);
      default:
        return;
    }
  }

  void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles_.push_back({a, b, c}); }

  /// Vertex where the level crosses the edge between two nodes, made once.
  std::uint32_t crossing(std::size_t a, std::size_t b) {
    const std::size_t low = std::min(a, b), high = std::max(a, b);
    // From the lower node an edge leads to one of the seven other corners of a cube.
    const std::size_t step = high - low, sheet = size_[0] * size_[1];
    const std::size_t z = step >= sheet ? 1 : 0, y = step - z * sheet >= size_[0] ? 1 : 0,
                      x = step - z * sheet - y * size_[0];
    const std::uint64_t key = 8 * static_cast<std::uint64_t>(low) + x + 2 * y + 4 * z;
    const auto [entry, isNew] = vertexOf_.try_emplace(key, static_cast<std::uint32_t>(vertices_.size()));
    if (!isNew) return entry->second;
    const double atLow = distanceOf(squared_[low]), atHigh = distanceOf(squared_[high]);
    const double share = (kLevel - atLow) / (atHigh - atLow);
    vertices_.push_back(positionOf(low) + share * (positionOf(high) - positionOf(low)));
    return entry->second;
  }

  glm::dvec3 positionOf(std::size_t node) const {
    const std::size_t row = node / size_[0] % size_[1], layer = node / (size_[0] * size_[1]);
    return origin_ + cell_ * glm::dvec3(static_cast<double>(node % size_[0]), static_cast<double>(row),
                                        static_cast<double>(layer));
  }

  double cell_;
  glm::dvec3 origin_{0.0};
  std::array<double, 3> counts_{};
  std::array<std::size_t, 3> size_{};
  /// Squared distance of each node from the nearest sample [cells^2].
  std::vector<std::uint8_t> squared_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertexOf_;
  std::vector<glm::dvec3> vertices_;
  std::vector<Triangle> triangles_;
};

/// A moving part with its samples.
struct SweptPart {
  std::vector<glm::dvec3> points;
  std::vector<RigidTransform> poses;
};

}  // namespace

double defaultSweptResolution(const Scene& scene, const AssemblyPath& path) {
  constexpr double kShare = 0.05;
  double size = 0.0;
  for (const PathPart& moving : pathBodies(scene, path).moving)
    size = std::max(size, moving.part->geometry->mesh.bounds().diagonal());
  return kShare * size;
}

TriangleMesh sweptVolume(const Scene& scene, const AssemblyPath& path, double resolution,
                         const ProgressCallback& progress) {
  constexpr double kSampled = 0.6, kMaxPoints = 1e8, kMaxPoses = 1e7;
  checkPath(path, "path");
  const PathBodies bodies = pathBodies(scene, path);
  const auto fail = [&] {
    throw UsageError("swept volume", fmt::format("a resolution of {} m cannot be made", resolution),
                     "give a coarser one, such as a twentieth of the part");
  };
  if (!(resolution > 0.0) || !std::isfinite(resolution)) fail();
  const double cell = kCellShare * resolution;
  std::vector<SweptPart> parts;
  Aabb box;
  for (const PathPart& moving : bodies.moving) {
    const TriangleMesh& mesh = moving.part->geometry->mesh;
    if (countOfPoints(mesh, cell) > kMaxPoints) fail();
    if (PathTravel(path, moving).at(path.end()) > kMaxPoses * resolution) fail();
    parts.push_back({surfacePoints(mesh, cell), sampledPoses(path, moving, kMotionShare * resolution)});
    for (const RigidTransform& worldFromPart : parts.back().poses) {
      for (const glm::dvec3& corner : moving.corners)
        box.add(worldFromPart.applyToPoint(moving.leadFromPart.inverse().applyToPoint(corner + path.centre)));
    }
  }
  SweptLattice lattice(box, cell);
  if (!(lattice.nodes() <= kMaxSweptNodes)) fail();
  lattice.allocate();
  const ProgressCallback sampling = stageCallback(progress, 0.0, kSampled);
  double total = 0.0;
  for (const SweptPart& part : parts)
    total += static_cast<double>(part.poses.size()) * static_cast<double>(part.points.size());
  SharedProgress done(sampling, std::max(1.0, total));
  for (const SweptPart& part : parts) {
    parallelFor(part.poses.size(), [&](std::size_t i) {
      for (const glm::dvec3& point : part.points)
        lattice.mark(part.poses[i].applyToPoint(point));
      done.add(static_cast<double>(part.points.size()));
    });
  }
  lattice.spread();
  lattice.fill();
  return lattice.surface(stageOf(progress, kSampled, 1.0));
}

std::size_t writeSweptVolume(const Scene& scene, const AssemblyPath& path, double resolution,
                             double metresPerUnit, const std::filesystem::path& file,
                             const ProgressCallback& progress) {
  const std::optional<ExportKind> kind = exportKindOf(file);
  const std::optional<MeshFileKind> mesh = kind ? meshKindOf(*kind) : std::nullopt;
  if (!mesh)
    throw UsageError(file.string(), "its suffix is not that of a mesh file", "use .stl, .obj or .ply");
  const auto geometry = std::make_shared<PartGeometry>();
  geometry->mesh = sweptVolume(scene, path, resolution, progress);
  Part part;
  part.name = "Swept volume";
  part.geometry = geometry;
  const std::vector<Scene::PartPtr> parts{std::make_shared<const Part>(std::move(part))};
  exportMesh(parts, *mesh, metresPerUnit, file);
  return geometry->mesh.triangles().size();
}

}  // namespace nearfit
