#pragma once

#include <cstddef>
#include <filesystem>

namespace nearfit::bench {

/// An assembly of perforated plates.
struct AssemblyOptions {
  std::size_t instances = 300;
  std::size_t shapes = 12;  ///< Plates that differ in the radius of their holes; each is a product.
  std::size_t triangles =
      1'000'000;  ///< Of all instances together, meshed by default; some per cent more or less.
};

/// Writes the assembly as a STEP file. Throws UsageError, FileError.
void writeAssembly(const AssemblyOptions& options, const std::filesystem::path& file);

}  // namespace nearfit::bench
