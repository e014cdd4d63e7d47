#pragma once

#include <cstddef>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/base/progress.h"
#include "core/session/session_command.h"
#include "core/text/json_file.h"

/// Commands of a session as JSON objects, the lines of a script (format: resources/docs/scripts.md). Parts are named,
/// groups and joints named and numbered, files given by path: IDs are of one run only. Numbers read back as the same
/// double.
namespace nearfit {

/// Max length of the texts that only undo labels show [bytes of UTF-8].
constexpr std::size_t kMaxStepLabelBytes = 1000;

/// @param before  The scene that the command is carried out on.
/// @param script  The file that the line will be in: paths of meshes are relative to its folder.
/// Throws FileError if a path is not UTF-8, UsageError if `before` lacks a node of the command.
nlohmann::ordered_json commandJson(const SessionCommand& command, const Scene& before,
                                   const std::filesystem::path& script);

/// Reads a command and loads the meshes that it names. Blocking.
/// @param line    An object in the format of commandJson(); nothing in it is trusted.
/// @param scene   The scene that the command is meant for.
/// @param folder  Start of relative mesh paths, as meshFolder() returns it.
/// Throws FileError naming the field, also if the scene would get more parts than a scene file holds; Cancelled.
SessionCommand readCommand(const JsonField& line, const Scene& scene, const std::filesystem::path& folder,
                           const ProgressCallback& progress = {});

}  // namespace nearfit
