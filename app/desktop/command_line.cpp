#include "app/desktop/command_line.h"

#include <cstdio>

#include <CLI/CLI.hpp>

namespace nearfit::desktop {
namespace {

constexpr int kUsage = 2;

}  // namespace

std::variant<Options, int> parseCommandLine(int argc, const char* const* argv) {
  CLI::App program("Feel one part against the others before any of them exists.", "nearfit");
  program.footer(
      "Without files it starts empty. Mesh files are read in the unit that was used last (at first mm).");
  program.set_version_flag("--version", std::string("nearfit ") + NEARFIT_VERSION);
  Options options;
  program.add_option("FILE", options.files, "Scene (*.nearfit) or mesh (STL, OBJ, PLY, OFF) to open");
  program.add_option(
      "--screenshot", options.screenshot,
      "Write a picture (PNG) of the window with the files and end; a moving part is felt for it");
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return program.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "nearfit: %s; see nearfit --help\n", error.what());
    return kUsage;
  }
  return options;
}

}  // namespace nearfit::desktop
