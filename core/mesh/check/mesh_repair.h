#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Kinds of repair.
enum class RepairKind : std::uint8_t {
  Weld,        ///< Merges vertices nearer than the size.
  Stitch,      ///< Closes cracks: merges and splits along open borders nearer than the size.
  Clean,       ///< Removes faces without area and faces that repeat others.
  Orient,      ///< Makes neighbours agree, and turns closed shells so that their outside is outside.
  FillHoles,   ///< Fills holes whose box has a diagonal of at most the size.
  DropShells,  ///< Removes components whose box has a diagonal of at most the size.
};
constexpr std::size_t kRepairKinds = 6;

/// One repair with its parameter.
struct MeshRepair {
  RepairKind kind{};
  double size = 0.0;  ///< [m]; see RepairKind. 0 for kinds without one.
  bool operator==(const MeshRepair&) const = default;
};

/// Repairs in the order in which they are made.
using MeshRepairs = std::vector<MeshRepair>;
/// Repairs that a user chooses, each by itself; sizes in [m].
struct RepairChoice {
  std::optional<double> weld, stitch, drop, fill;
  bool clean = false, orient = false;
};
/// The chosen repairs in the order in which each finds what it needs: faces agree before holes are filled, and are
/// turned outward once they are.
MeshRepairs repairsOf(const RepairChoice& choice);

/// Max number of repairs of one mesh.
constexpr std::size_t kMaxRepairs = 100;
/// Limits of MeshRepair::size [m].
constexpr double kMinRepairSize = 1e-12, kMaxRepairSize = 1e6;

/// True if repairs of that kind have a size.
bool hasSize(RepairKind kind) noexcept;
/// Throws UsageError if there are too many repairs, or a size is out of range.
void checkRepairs(std::span<const MeshRepair> repairs);
/// The same repairs for the mesh scaled by a factor; sizes stay within their limits.
MeshRepairs scaledRepairs(MeshRepairs repairs, double factor);
/// Text that differs for different repairs; empty for none.
std::string textOf(std::span<const MeshRepair> repairs);
/// Word for files and options: "fillHoles". The other way round; nullopt if there is no such word.
std::string_view wordOf(RepairKind kind) noexcept;
std::optional<RepairKind> repairNamed(std::string_view word) noexcept;

/// Changes that one repair made.
struct RepairStep {
  MeshRepair repair;
  /// Weld, Stitch: vertices merged. Clean: flat faces swapped with a neighbour. Orient: faces turned. FillHoles: holes
  /// filled. DropShells: components removed.
  std::uint64_t changed = 0;
  std::uint64_t addedFaces = 0, removedFaces = 0;
  /// Could not be done: edges that still disagree (Orient), holes small enough but not filled (FillHoles).
  std::uint64_t left = 0;
  /// Clean: the removed faces of walls, which separate two parts of a solid and face both ways. Where they were, no
  /// surface is left.
  std::uint64_t wallFaces = 0;

  bool isNothing() const noexcept { return changed == 0 && addedFaces == 0 && removedFaces == 0; }
};

/// A mesh after repairs.
struct RepairedMesh {
  static constexpr std::uint32_t kNoOrigin = std::numeric_limits<std::uint32_t>::max();

  TriangleMesh mesh;  ///< Shares the arrays of the original if nothing was changed.
  /// For each triangle: the one of the original that it is, or is a fragment of; kNoOrigin for one that fills a hole.
  std::vector<std::uint32_t> originOf;
  std::vector<RepairStep> steps;  ///< One for each repair.
};

/// Repairs a copy of a mesh. The same mesh and repairs always give the same result, so that a scene needs to keep the
/// repairs only. Time and memory grow with the size of the mesh, O(n log n) for each repair.
/// Throws UsageError (checkRepairs), Error if no face would be left, Cancelled. Not for the GUI or servo thread.
RepairedMesh repairMesh(const TriangleMesh& mesh, std::span<const MeshRepair> repairs,
                        const ProgressCallback& progress = {});

/// How two meshes differ, and by how much.
struct MeshChange {
  /// Max number of points that are measured.
  static constexpr std::size_t kMaxSamples = 200'000;

  struct Side {
    std::uint64_t triangles = 0, openEdges = 0, components = 0;
    double area = 0.0;             ///< [m^2]
    std::optional<double> volume;  ///< Signed [m^3]; nullopt if the mesh is not closed and oriented.
  };
  Side before, after;
  /// Max distance between the surfaces [m]: from corners, middles of sides and centres of the triangles that only
  /// one of them has to the other surface; faces without area are no surface. A fill is so far from the old surface as its middle is from the rim.
  double maxDistance = 0.0;
  bool isOfRemoved = false;  ///< The max is from a face that is gone to the surface that is left.
  bool isSampled = false;    ///< There were more points than kMaxSamples: only some were measured, evenly.
};

/// Compares a mesh with its repaired copy. O(n log n). Throws Cancelled.
MeshChange changeBetween(const TriangleMesh& before, const TriangleMesh& after,
                         const ProgressCallback& progress = {});

}  // namespace nearfit
