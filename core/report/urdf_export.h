#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "core/base/progress.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Files of a URDF export besides the URDF file.
struct UrdfExport {
  std::filesystem::path folder;               ///< Folder of the meshes: NAME_meshes beside NAME.urdf.
  std::vector<std::filesystem::path> meshes;  ///< One for each geometry.
};

/// Writes parts as a robot of fixed joints (URDF), its meshes beside it.
///
/// - The root link "world" has the scene's frame. Each group and part is a link of its name, on a fixed joint; where a
///   group's name is taken, it gets a number. Groups have no origin and no mesh.
/// - A part's joint has its worldFromPart as xyz [m] and rpy [rad]. Numbers have the fewest digits that read back as the
///   same double.
/// - Visual and collision meshes are binary STL files in metres in the part's frame, one for each geometry, whatever the
///   number of its parts. Colour and opacity are the part's; colours of faces are lost.
/// - A part has mass and inertia if its density was set (other than kDefaultDensity) and its mesh encloses a volume.
///
/// Names of mesh files hold a part of their content's SHA-256: an older URDF file beside them keeps its own, and each file
/// is written atomically, the URDF file last. Files that no URDF file names any more stay.
/// @param scene  Has the moving part where it is now (placedScene()).
/// @param parts  Of the scene; see chosenParts().
/// Throws FileError; UsageError (no parts); Cancelled, which keeps the old URDF file. Blocking.
UrdfExport exportUrdf(const Scene& scene, std::span<const Scene::PartPtr> parts,
                      const std::filesystem::path& file, const ProgressCallback& progress = {});

/// Roll, pitch and yaw of a unit quaternion [rad]: about the fixed axes x, y and z, in this order, pitch from -pi/2 to
/// pi/2. As exact as the quaternion also where pitch is +-pi/2, where only roll - yaw or roll + yaw is determined.
/// Source: E. Bernardes, S. Viollet, Quaternion to Euler angles conversion: a direct, general and computationally
/// efficient method, 2022.
std::array<double, 3> rollPitchYaw(const glm::dquat& rotation);

}  // namespace nearfit
