#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "core/scene/scene.h"

namespace nearfit {

enum class MeshFileKind : std::uint8_t { StlBinary, Obj, Ply };

/// "stl", "obj" or "ply": what such a file's name ends in.
std::string_view extensionOf(MeshFileKind kind) noexcept;

/// What a merged mesh holds.
struct MeshExportSize {
  std::size_t parts = 0;
  std::uint64_t vertices = 0, triangles = 0;
  /// Of the file [bytes]: exact for STL and PLY, about right for OBJ, whose numbers are text.
  std::uint64_t bytes = 0;
};

/// The scene with its moving part where it is now.
/// @param worldFromMoving  Unused when there is no moving part. Throws UsageError when it is no pose.
Scene placedScene(const Scene& scene, const RigidTransform& worldFromMoving);

/// Those of the scene's parts that are in `only`, in the scene's order; all visible ones where it is empty.
std::vector<Scene::PartPtr> chosenParts(const Scene& scene, std::span<const PartId> only);

/// Before it is written; O(number of parts).
MeshExportSize meshExportSize(std::span<const Scene::PartPtr> parts, MeshFileKind kind) noexcept;

/// Writes the parts as one mesh in the world frame, atomically.
///
/// - Binary STL has single precision (about seven figures) and no names.
/// - OBJ has as many digits as it takes to read the same double again; each part is an object (`o`, its name
///   as it is) and a group (`g`, blanks in the name as `_`, as they separate groups).
/// - PLY is binary, little endian, in double precision; each vertex has its part's colour.
///
/// A vertex is where `worldFromPart.applyToPoint` puts it, over `metresPerUnit`.
/// @param metresPerUnit  Of the numbers in the file.
/// Throws FileError, UsageError (the unit, no parts, more triangles than the format can count), Cancelled,
/// which leaves the old file. Blocking; memory does not depend on the size of the meshes.
MeshExportSize exportMesh(std::span<const Scene::PartPtr> parts, MeshFileKind kind, double metresPerUnit,
                          const std::filesystem::path& file, const ProgressCallback& progress = {});

}  // namespace nearfit
