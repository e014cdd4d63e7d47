#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "core/path/assembly_path.h"
#include "core/scene/scene.h"
#include "tests/bench/many_parts.h"

namespace nearfit::bench {

/// nearfit-cli, beside this program; empty where it is not built.
std::filesystem::path cliProgram();

/// A scene with one of its parts in hand, and a path of it that is proven free.
struct LiftedPart {
  Scene scene;
  AssemblyPath path;
  double separation = 0.0;  ///< Kept all along the path [m].
};

/// Lifts one of the last parts along z out of the others, and turns it about z as it rises. Throws Error if none of the
/// last can be lifted so.
/// @param poses  Of the path; 2 or more.
LiftedPart liftOut(const ManyPartsScene& many, std::size_t poses);

/// Writes scene, path and certificate to files and times `nearfit-cli report`, as a process, from these to the HTML file
/// [s]: reading, hierarchies (nothing comes from the cache), the check, clearances along the path, the certificate proven
/// anew, pictures. Throws Error with what the program says.
/// @param threshold  Of the check [m].   @param repeats  Number of runs.
std::vector<double> reportTimes(const std::filesystem::path& cli, const LiftedPart& lifted, double threshold,
                                std::size_t repeats);

}  // namespace nearfit::bench
