#pragma once

#include <cstddef>
#include <filesystem>

#include "core/base/progress.h"
#include "core/mesh/triangle_mesh.h"
#include "core/path/assembly_path.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Max number of lattice nodes of a swept volume: some 800 MB while it is made.
constexpr double kMaxSweptNodes = 2e8;

/// Resolution of a swept volume if none is given: a twentieth of the diagonal of the largest moving part [m], some
/// seconds for a part that goes once its own length. Throws
/// UsageError as pathBodies().
double defaultSweptResolution(const Scene& scene, const AssemblyPath& path);

/// Space that the moving parts pass on a path, as a closed mesh in the world frame.
///
/// Conservative: every point that their surfaces pass, everywhere on the path, is inside, and so is all that cannot be
/// reached from outside without passing them, such as the material within them and gaps finer than the resolution. No
/// point of the mesh is farther than the resolution from a point that they pass.
///
/// Surfaces are sampled at poses between which nothing moves farther than two thirds of the resolution; the distance
/// from the samples on a lattice, cut at a level that covers all that sampling and interpolation may miss, gives the
/// mesh by marching tetrahedra. Time and memory grow with the cube of the size over the resolution. On all processors.
/// @param resolution  [m]; > 0.
/// Throws UsageError if the resolution is invalid or would need more than kMaxSweptNodes, or as checkPath() and
/// pathBodies(); Cancelled.
TriangleMesh sweptVolume(const Scene& scene, const AssemblyPath& path, double resolution,
                         const ProgressCallback& progress = {});

/// Writes the swept volume as a mesh of one part named "Swept volume", atomically; returns its number of triangles.
/// @param metresPerUnit  Unit of the numbers in the file [m].
/// @param file           Its suffix chooses the format: .stl (binary), .obj or .ply, in any case.
/// Throws UsageError if the suffix is another, or the unit invalid; as sweptVolume() and exportMesh(). Blocking.
std::size_t writeSweptVolume(const Scene& scene, const AssemblyPath& path, double resolution,
                             double metresPerUnit, const std::filesystem::path& file,
                             const ProgressCallback& progress = {});

}  // namespace nearfit
