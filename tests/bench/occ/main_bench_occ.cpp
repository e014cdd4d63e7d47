// OpenCASCADE without Nearfit: what nearfit-bench compares imports with, and documents made for that.
#include <memory>

#include <CLI/CLI.hpp>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Standard_Failure.hxx>
#include <fmt/format.h>

#include "core/base/error.h"
#include "tests/bench/command_program.h"
#include "tests/bench/occ/made_assembly.h"
#include "tests/bench/occ/read_document.h"

namespace {

using namespace nearfit;

/// Does something, and throws what OpenCASCADE throws as an error of ours.
template <typename Act>
void byOcc(const std::filesystem::path& file, Act act) {
  // Its messages would come between the figures.
  Message::DefaultMessenger()->ChangePrinters().Clear();
  try {
    act();
  } catch (const Standard_Failure& failure) {
    throw FileError(file.string(), fmt::format("OpenCASCADE fails: {}", failure.GetMessageString()));
  }
}

void addReadCommand(CLI::App& program) {
  const auto file = std::make_shared<std::filesystem::path>();
  CLI::App* command = program.add_subcommand(
      "read", "Reads and meshes a STEP file and prints times, counts and peak memory, as JSON.");
  command->add_option("file", *file, "The file")->required()->check(CLI::ExistingFile);
  command->callback(
      [file] { byOcc(*file, [&] { fmt::print("{}", bench::textOf(bench::readAndMesh(*file))); }); });
}

void addMakeCommand(CLI::App& program) {
  const auto file = std::make_shared<std::filesystem::path>();
  const auto options = std::make_shared<bench::AssemblyOptions>();
  CLI::App* command = program.add_subcommand("make", "Writes an assembly of perforated plates as STEP.");
  command->add_option("file", *file, "The file")->required();
  command->add_option("--instances", options->instances, "Plates in the assembly")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  command->add_option("--shapes", options->shapes, "Plates that differ")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  command
      ->add_option("--triangles", options->triangles,
                   "Of all together, meshed by default; some per cent more or less")
      ->check(CLI::Range(1000, 100'000'000))
      ->capture_default_str();
  command->callback([file, options] { byOcc(*file, [&] { bench::writeAssembly(*options, *file); }); });
}

void addCommands(CLI::App& program, int, char**) {
  addReadCommand(program);
  addMakeCommand(program);
}

}  // namespace

int main(int argc, char** argv) {
  return bench::runProgram(
      {"nearfit-bench-occ", "Reads, meshes and makes STEP files by OpenCASCADE alone.", "", addCommands},
      argc, argv);
}
