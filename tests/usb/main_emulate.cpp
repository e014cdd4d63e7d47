#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "tests/usb/emulation_options.h"

namespace {

/// Becomes the command; returns only when that failed, what main() returns.
int run(int argc, char** argv) {
  nearfit::test::EmulationOptions options;
  options.unplug = "eshutdown";
  std::vector<std::string> command;
  CLI::App app{"Runs a program as if a device were plugged in. No hardware, no privileges.",
               "nearfit-emulate"};
  app.add_option("kind", options.kind, "Device: openhap, spacemouse, polhem, falcon")
      ->required()
      ->check(CLI::IsMember({"openhap", "spacemouse", "polhem", "falcon"}));
  app.add_option("--rate", options.rate, "Reports a second instead of the device's own [Hz]")
      ->check(CLI::Range(1.0, 8000.0));
  app.add_option("--seconds", options.seconds, "Unplug it so long after the program first looked at it [s]")
      ->check(CLI::PositiveNumber);
  app.add_option("--reports", options.reports, "Unplug it after so many reports")->check(CLI::PositiveNumber);
  app.add_option("--unplug", options.unplug, "How that shows itself: eproto, eshutdown, nodevice")
      ->check(CLI::IsMember({"eproto", "eshutdown", "nodevice"}));
  app.add_option("--path", options.path, "CSV of the handle's poses, one a report (openhap)")
      ->check(CLI::ExistingFile);
  app.add_option("--firmware", options.firmware,
                 "The one file that it takes for its firmware; without, it has its firmware already (falcon)")
      ->check(CLI::ExistingFile);
  app.add_option("--program", options.program,
                 "Name of the program that sees it, where COMMAND only starts that");
  app.add_option("command", command, "After --: the program and its arguments")->required();
  CLI11_PARSE(app, argc, argv);

  if (!options.path.empty()) options.path = std::filesystem::absolute(options.path).string();
  if (!options.firmware.empty()) options.firmware = std::filesystem::absolute(options.firmware).string();
  if (options.program.empty()) options.program = std::filesystem::path(command.front()).filename().string();
  options.toEnvironment();
  std::string preload = std::string(NEARFIT_EMULATION_LIBRARY) + ":" + NEARFIT_UMOCKDEV_LIBRARY;
  if (const char* others = std::getenv("LD_PRELOAD")) preload += std::string(":") + others;
  ::setenv("LD_PRELOAD", preload.c_str(), 1);
#ifdef NEARFIT_SANITIZED_ADDRESS
  // The library goes before the sanitizer's own, which minds, although the two take over different functions.
  const char* given = std::getenv("ASAN_OPTIONS");
  ::setenv("ASAN_OPTIONS", (std::string(given == nullptr ? "" : given) + ":verify_asan_link_order=0").c_str(),
           1);
#endif

  std::vector<char*> arguments;
  for (std::string& each : command)
    arguments.push_back(each.data());
  arguments.push_back(nullptr);
  ::execvp(arguments.front(), arguments.data());
  std::fprintf(stderr, "nearfit-emulate: %s: it could not be run: %s; check its name\n", arguments.front(),
               std::strerror(errno));
  return 127;
}

}  // namespace

/// nearfit-emulate KIND [options] -- COMMAND...: runs a program, unchanged, as if a device were plugged in.
int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "nearfit-emulate: %s\n", error.what());
    return 1;
  }
}
