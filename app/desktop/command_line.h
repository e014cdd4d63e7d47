#pragma once

#include <QStringList>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/import/cad_document.h"

namespace nearfit::desktop {

/// Options of the command line.
struct Options {
  std::vector<std::string> files;       ///< Meshes, documents, folders, and at most one scene.
  std::optional<double> metresPerUnit;  ///< Of files that store none; std::nullopt: the window asks.
  /// Tessellation of documents; std::nullopt: as the user chose it in the window. An unattended run always sets it, so
  /// that its picture does not depend on that choice.
  std::optional<Tessellation> tessellation;
  bool isDemo = false;                ///< Opens the demo scene.
  std::string screenshot;             ///< File for a picture of the window; empty: a normal run.
  std::optional<std::string> device;  ///< Takes the part in hand at once; empty text: the first usable one.
  bool isArming = false;              ///< Arms the device as soon as it is ready.
  std::optional<double> seconds;      ///< Ends after that time [s].
  std::string record;                 ///< File for what is felt; empty: none.
  std::string script;                 ///< Script to replay at the start; empty: none.

  /// True if nobody watches the run, or it ends by itself: it must not ask questions.
  bool isUnattended() const noexcept { return !screenshot.empty() || seconds.has_value(); }
};

/// Exit code of wrong usage.
constexpr int kUsageExitCode = 2;

/// Returns the options, or the exit code if nothing is left to do (help, version, wrong
/// usage: already printed).
std::variant<Options, int> parseCommandLine(int argc, const char* const* argv);

/// Throws UsageError if an unattended run has files that store no unit, and none is given.
/// @param files  The options' files, decoded; files in folders among them count. Needs the QCoreApplication.
void requireUnit(const Options& options, const QStringList& files);

/// Throws UsageError if an output would replace an input or another output, or the picture's name is not that of one, and
/// FileError if an output names what is not replaced: a folder, device, pipe or socket.
/// @param files  As for requireUnit(); those in folders are not looked for.
void requireTargets(const Options& options, const QStringList& files);

}  // namespace nearfit::desktop
