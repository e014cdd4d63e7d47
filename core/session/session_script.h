#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/session/session.h"

/// Scripts: the commands of a session as JSON lines, behind a first line that gives the version and the scene to start
/// from (format: resources/docs/scripts.md). Nothing in them is trusted.
namespace nearfit {

/// Version that this program writes, and the only one that it reads.
constexpr int kScriptVersion = 1;
/// Limits on a script: size of the file and of one line [bytes], and number of lines.
constexpr std::size_t kMaxScriptBytes = 64U << 20U, kMaxScriptLineBytes = 16U << 20U,
                      kMaxScriptLines = 100'000;
/// Limits that a recording keeps to. Others than those of readScript() are for tests.
struct ScriptLimits {
  std::size_t maxBytes = kMaxScriptBytes, maxLineBytes = kMaxScriptLineBytes, maxLines = kMaxScriptLines;
};

/// A script, its commands not looked at yet.
struct SessionScript {
  struct Line {
    std::size_t number;  ///< In the file, from 1.
    std::string text;
  };
  std::filesystem::path file;
  std::optional<std::filesystem::path> scene;  ///< Scene file to start from; std::nullopt: an empty scene.
  std::vector<Line> lines;                     ///< One command each.
};

/// First line of a script, without its end. Throws FileError if the name of the scene is not UTF-8.
/// @param scene  Scene file in the script's folder; std::nullopt: an empty scene.
std::string scriptHead(const std::optional<std::filesystem::path>& scene);

/// Throws FileError naming the line if the file is no script, of another version, or exceeds a limit.
SessionScript readScript(const std::filesystem::path& file);

/// The scene that the script starts from. Meshes that changed since it was saved are taken as they are, as for parts that
/// the script adds. Blocking.
/// @param changedMeshes  Receives those meshes; may be null.
/// Throws as readSceneFile().
Scene startOf(const SessionScript& script, const ProgressCallback& progress = {},
              std::vector<std::filesystem::path>* changedMeshes = nullptr);

/// Carries out the commands one after the other, each as one undo step. Blocking.
/// @param session   In the state that the script is meant for.
/// @param progress  Fraction of the lines; also told within a line that loads meshes.
/// Throws FileError with file, line, problem and remedy, or Cancelled; the session is then as before that line.
void replay(const SessionScript& script, Session& session, const ProgressCallback& progress = {});

}  // namespace nearfit
