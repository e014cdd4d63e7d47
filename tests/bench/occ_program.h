#pragma once

#include <cstddef>
#include <filesystem>

#include "tests/bench/import_run.h"

/// nearfit-bench-occ, which links OpenCASCADE; this program does not.
namespace nearfit::bench {

/// The program, beside this one; empty where it is not built.
std::filesystem::path occProgram();

/// Reads and meshes a STEP file by OpenCASCADE alone. Throws Error with what the program says.
OccRun runOcc(const std::filesystem::path& program, const std::filesystem::path& file);

/// An assembly to be made: `shapes` perforated plates that differ, placed `instances` times, of some `triangles` in all.
struct AssemblySize {
  std::size_t instances = 300, shapes = 300, triangles = 1'000'000;
};
/// Has it written as a STEP file. Throws Error with what the program says.
void makeAssembly(const std::filesystem::path& program, const AssemblySize& size,
                  const std::filesystem::path& file);

}  // namespace nearfit::bench
