#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/path/assembly_path.h"
#include "core/scene/scene.h"

namespace nearfit::bench {

/// A scene, and a path on which what is in hand stays free of all else.
struct PathBenchScene {
  std::string name;
  Scene scene;
  AssemblyPath path;
};

/// A scene that is made when it is wanted.
struct PathSceneEntry {
  std::string name;
  std::function<PathBenchScene()> make;
};

/// Generated paths, each of so many poses, 2 or more, a millisecond apart, but where another number is said:
/// "peg", which is screwed into its bore, four turns with a play of some 0.08 mm; "rocks", two scans of 20,480 triangles
/// of which one passes the other as near as a twentieth of its radius, turning; "pipe", a bent pipe that is drawn
/// through the hole of a plate, round its bend; "among-200", a scan of 5,120 triangles that passes between the 200 parts
/// of fittedParts() through one channel after the other, turning; "group-among-200", a group of three such scans on the
/// same way; "suggested-peg" and "suggested-pipe", which searchPath() finds into the hole, with as many poses as it gives
/// them; "recorded-peg", a peg that a hand presses against the wall of its hole in the proxy mode, recorded for so many
/// ticks and thinned.
std::vector<PathSceneEntry> generatedPathScenes(std::size_t poses);

/// Paths of the shared models: "peghole", a round peg that is screwed into its hole, and "pump", the axis that is let
/// down into the lower half. Empty if the folder has no models.
/// @param shared  Folder of the shared models; may be empty.
std::vector<PathSceneEntry> sharedPathScenes(const std::filesystem::path& shared, std::size_t poses);

}  // namespace nearfit::bench
