#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/commands.h"
#include "app/cli/interrupt.h"
#include "app/cli/output.h"
#include "app/cli/progress_line.h"
#include "core/base/progress.h"
#include "core/files/atomic_write.h"
#include "core/scene/part_files.h"
#include "core/scene/scene_file.h"
#include "core/session/session_script.h"

namespace nearfit::cli {
namespace {

struct ScriptOptions {
  std::string script, scene, out;
};

constexpr const char* kScriptFooter =
    "A script is what Record commands of the window writes: one JSON object on each line, see scripts.md. "
    "Paths in "
    "it start at its folder. The first line that cannot be carried out ends the replay, and no scene is "
    "written.";

/// Shows the progress on the line, and stops at an interrupt.
ProgressCallback scriptProgress(ProgressLine& line) {
  return [&line](double fraction) {
    line.show(fraction);
    return !InterruptGuard::isInterrupted();
  };
}

void runScript(const ScriptOptions& options) {
  SessionScript script = readScript(options.script);
  if (!options.scene.empty()) script.scene = options.scene;
  std::vector<std::filesystem::path> inputs{options.script};
  if (script.scene) inputs.push_back(*script.scene);
  checkTarget(options.out, inputs);
  checkReplaceable(options.out);
  const InterruptGuard guard;
  std::vector<std::filesystem::path> changed;
  Session session;
  {
    ProgressLine line("opening");
    session.reset(startOf(script, scriptProgress(line), &changed));
  }
  for (const std::filesystem::path& mesh : changed)
    printError(fmt::format("warning: {}: it has changed since the scene was saved", mesh.string()));
  {
    ProgressLine line("replaying");
    replay(script, session, scriptProgress(line));
  }
  checkTarget(options.out, partFiles(session.scene()));
  session.save(options.out);
}

}  // namespace

void addScriptCommand(CLI::App& program) {
  const auto options = std::make_shared<ScriptOptions>();
  CLI::App* command = program.add_subcommand(
      "script", "Replays a script of the window's commands and writes the scene that they lead to.");
  command->add_option("script", options->script, "Script (*.jsonl)")->required()->type_name("SCRIPT");
  command
      ->add_option(
          "--scene", options->scene,
          "Scene file (*.nearfit) to start from; default: the one that the script names, else an empty scene")
      ->type_name("SCENE");
  command->add_option("-o,--out", options->out, "Scene file to write")->required()->type_name("OUT.nearfit");
  command->footer(kScriptFooter);
  command->callback([options] { runScript(*options); });
}

}  // namespace nearfit::cli
