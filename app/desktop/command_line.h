#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace nearfit::desktop {

struct Options {
  std::vector<std::string> files;     ///< Meshes, and at most one scene.
  bool isDemo = false;                ///< Opens the demo scene.
  std::string screenshot;             ///< File to write a picture of the window to; empty for a normal run.
  std::optional<std::string> device;  ///< Takes the part in hand at once; empty text: the first one.
  bool isArming = false;
  std::optional<double> seconds;
  std::string record;  ///< File for what is felt; empty for none.
};

/// The options, or the exit code when there is nothing more to do (help, version, wrong usage: already
/// printed).
std::variant<Options, int> parseCommandLine(int argc, const char* const* argv);

}  // namespace nearfit::desktop
