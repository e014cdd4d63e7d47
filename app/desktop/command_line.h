#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace nearfit::desktop {

/// Options of the command line.
struct Options {
  std::vector<std::string> files;       ///< Meshes, and at most one scene.
  std::optional<double> metresPerUnit;  ///< Of the meshes; std::nullopt: the window asks.
  bool isDemo = false;                  ///< Opens the demo scene.
  std::string screenshot;               ///< File for a picture of the window; empty: a normal run.
  std::optional<std::string> device;    ///< Takes the part in hand at once; empty text: the first usable one.
  bool isArming = false;                ///< Arms the device as soon as it is ready.
  std::optional<double> seconds;        ///< Ends after that time [s].
  std::string record;                   ///< File for what is felt; empty: none.

  /// True if nobody watches the run, or it ends by itself: it must not ask questions.
  bool isUnattended() const noexcept { return !screenshot.empty() || seconds.has_value(); }
};

/// Returns the options, or the exit code if nothing is left to do (help, version, wrong
/// usage: already printed). An unattended run has a unit: millimetres if none is given.
std::variant<Options, int> parseCommandLine(int argc, const char* const* argv);

}  // namespace nearfit::desktop
