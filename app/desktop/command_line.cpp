#include "app/desktop/command_line.h"

#include <cstdio>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "app/desktop/hands.h"
#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/scene/document_load.h"
#include "core/scene/mesh_unit.h"
#include "ui/files/dropped_files.h"
#include "ui/widgets/paths.h"

namespace nearfit::desktop {
namespace {

int failUsage(const char* problem) {
  std::fprintf(stderr, "nearfit: %s; see nearfit --help\n", problem);
  return kUsageExitCode;
}

bool isPng(const std::filesystem::path& file) {
  return ui::fromPath(file.extension()).compare(QStringLiteral(".png"), Qt::CaseInsensitive) == 0;
}

}  // namespace

std::variant<Options, int> parseCommandLine(int argc, const char* const* argv) {
  CLI::App program("Feel one part against the others before any of them exists.", "nearfit");
  program.footer(
      "Without files it starts with an empty scene; the first time, with the demo scene and a short tour. "
      "Without --unit it asks for the unit of mesh and BREP files, which store none; with --screenshot or "
      "--seconds nobody is asked, and --unit must be given.");
  program.set_version_flag("--version", std::string("nearfit ") + NEARFIT_VERSION);
  Options options;
  CLI::Option* files = program.add_option("FILE", options.files,
                                          "Scene (*.nearfit), mesh (STL, OBJ, PLY, OFF) or CAD document "
                                          "(STEP, IGES, BREP, glTF, 3MF, URDF) to open");
  std::string unit;
  CLI::Option* unitOption = program
                                .add_option("--unit", unit,
                                            "Unit of the coordinates of files that store none: m, cm, mm, "
                                            "um, in, ft, or a number of metres")
                                ->needs(files);
  double chord = 0.0, angle = 0.0;
  const CLI::Option* chordOption =
      program
          .add_option("--chord", chord,
                      "Max distance between the exact surfaces of CAD documents and their triangles [m]; 0: "
                      "chosen from each shape's size. Default: as chosen in the window")
          ->type_name("METRES")
          ->needs(files);
  const CLI::Option* angleOption =
      program
          .add_option("--angle", angle,
                      "Max angle between neighbouring facets of such a surface [degrees]; 0: the importer's")
          ->type_name("DEGREES")
          ->needs(files);
  CLI::Option* demo = program
                          .add_flag("--demo", options.isDemo,
                                    "Open a copy of the demo scene; the original is never overwritten")
                          ->excludes(files);
  program.add_option(
      "--screenshot", options.screenshot,
      "Write a picture (PNG) of the window with the files, then exit; a scripted hand moves the moving part");
  std::string device;
  CLI::Option* hand =
      program
          .add_option("--device", device,
                      "Feel the moving part at once, with a device that is plugged in (see nearfit-cli "
                      "devices; default: the first usable one) or a recorded hand, replay:FILE")
          ->type_name("[DEVICE]")
          ->expected(0, 1);
  program.add_flag("--arm", options.isArming, "With --device: let it push as soon as it is ready")
      ->needs(hand);
  program
      .add_option("--seconds", options.seconds,
                  "With --device: exit after this time [s] and print a summary (round trip in us)")
      ->type_name("S")
      ->check(CLI::Range(0.01, 1e6))
      ->needs(hand);
  program
      .add_option(
          "--record", options.record,
          "Write every tick to this CSV file, as nearfit-cli place --record does; each new run replaces it")
      ->type_name("FILE");
  program
      .add_option(
          "--script", options.script,
          "Replay the commands of a script (JSON lines, as Record commands writes them); nearfit-cli script "
          "needs no display")
      ->type_name("FILE")
      ->excludes(files)
      ->excludes(demo)
      ->excludes(hand)
      ->excludes("--screenshot");
  hand->excludes("--screenshot");
  demo->excludes(hand)->excludes("--screenshot");
  try {
    program.parse(argc, argv);
    if (!hand->empty()) options.device = device;
    if (!unitOption->empty()) options.metresPerUnit = parseMeshUnit(unit, "--unit");
    if (!chordOption->empty() || !angleOption->empty() || options.isUnattended())
      options.tessellation = tessellationOfOptions(chord, angle);
  } catch (const CLI::Success& help) {
    return program.exit(help);
  } catch (const CLI::ParseError& error) {
    return failUsage(error.what());
  } catch (const UsageError& error) {
    return failUsage(error.what());
  }
  return options;
}

void requireUnit(const Options& options, const QStringList& files) {
  if (!options.isUnattended() || options.metresPerUnit) return;
  for (const QString& file : ui::sortOut(files).meshes) {
    if (storesUnit(ui::toPath(file))) continue;
    throw UsageError("--unit", ui::toPath(file).string() + " stores no unit of length",
                     "give the one that its numbers are in, such as --unit mm");
  }
}

void requireTargets(const Options& options, const QStringList& files) {
  const std::filesystem::path picture = options.screenshot, record = options.record;
  if (!picture.empty() && !isPng(picture)) {
    throw UsageError("--screenshot", picture.string() + " does not end in .png",
                     "give the name of a PNG file after it");
  }
  if (!picture.empty() && !record.empty() && isSameTarget(picture, record))
    throw UsageError("--record", "it names the same file as --screenshot", "give two files");
  std::vector<std::filesystem::path> inputs;
  if (!options.script.empty()) inputs.emplace_back(options.script);
  for (const QString& file : files)
    inputs.push_back(ui::toPath(file));
  if (options.device) {
    const auto recording = recordingOf(QString::fromStdString(*options.device));
    if (recording) inputs.push_back(*recording);
  }
  for (const std::filesystem::path& output : {picture, record}) {
    if (output.empty()) continue;
    checkTarget(output, inputs);
    checkReplaceable(output);
  }
}

}  // namespace nearfit::desktop
