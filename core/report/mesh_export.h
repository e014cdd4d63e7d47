#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Mesh file formats; see exportMesh().
enum class MeshFileKind : std::uint8_t { StlBinary, Obj, Ply };

/// File name extension: "stl", "obj" or "ply".
std::string_view extensionOf(MeshFileKind kind) noexcept;

/// Size of a merged mesh.
struct MeshExportSize {
  std::size_t parts = 0;
  std::uint64_t vertices = 0, triangles = 0;
  /// Of the file [bytes]: exact for STL and PLY, an estimate for OBJ, whose numbers are text.
  std::uint64_t bytes = 0;
};

/// Returns the scene with its moving part at its present pose; the parts of a moving group move rigidly along.
/// @param worldFromMoving  Unused if there is no moving part. Throws UsageError if the pose is
///                         invalid (checkedPose).
Scene placedScene(const Scene& scene, const RigidTransform& worldFromMoving);

/// The scene's parts that are in `only`, in scene order; if `only` is empty, all visible parts. Omits parts
/// without geometry.
std::vector<Scene::PartPtr> chosenParts(const Scene& scene, std::span<const PartId> only);

/// Size of the export, without writing it; O(number of parts).
MeshExportSize meshExportSize(std::span<const Scene::PartPtr> parts, MeshFileKind kind) noexcept;

/// Writes the parts as one mesh in the world frame, atomically, and returns its size.
///
/// - Binary STL has single precision (about seven digits) and no names.
/// - OBJ has the fewest digits that read back as the same double. Each part is an object (`o`, with its name)
///   and a group (`g`, with blanks in the name replaced by `_`, since blanks separate groups).
/// - PLY is binary, little endian, in double precision; each vertex has its part's colour.
///
/// A vertex is `worldFromPart.applyToPoint(vertex) / metresPerUnit`.
/// @param metresPerUnit  Unit of the numbers in the file [m].
/// Throws FileError; UsageError (invalid unit, no parts, more triangles than the format can count);
/// Cancelled, which keeps the old file. Blocking; memory does not depend on the size of the meshes.
MeshExportSize exportMesh(std::span<const Scene::PartPtr> parts, MeshFileKind kind, double metresPerUnit,
                          const std::filesystem::path& file, const ProgressCallback& progress = {});

}  // namespace nearfit
