#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit::bench {

/// Two meshes to measure queries on, and where to begin.
struct BenchScene {
  std::string name;
  TriangleMesh scene, part;
  /// sceneFromPart of the first pose; without it the part comes in from outside.
  std::optional<RigidTransform> start;
  /// Farthest that the part's centre goes from where it starts [m]: what keeps it in a bore.
  std::optional<double> range;
  /// The part does not turn: what is parallel stays so.
  bool isStraight = false;

  /// The larger body's diagonal [m]: what the cutoff and the steps are fractions of.
  double size() const { return std::max(scene.bounds().diagonal(), part.bounds().diagonal()); }
};

/// A scene that is made when it is wanted.
struct SceneEntry {
  std::string name, description;
  std::function<BenchScene()> make;
};

/// Scenes of generated meshes; the same on every machine.
std::vector<SceneEntry> generatedScenes();

/// The four pairs of the paper's appendix, three more of their meshes and one of scans, from the folder of shared
/// models (`models/public` in it is read).
/// Throws FileError, when a scene is made, for a file that is not there.
std::vector<SceneEntry> sharedScenes(const std::filesystem::path& folder);

/// Two files of a user's. @param metresPerUnit  Of the files.
BenchScene sceneFromFiles(const std::filesystem::path& scene, const std::filesystem::path& part,
                          double metresPerUnit);

/// Meshes of about 10,000, 100,000 and a million triangles, for build times.
struct MeshEntry {
  std::string name;
  std::function<TriangleMesh()> make;
};
std::vector<MeshEntry> generatedMeshes();

}  // namespace nearfit::bench
