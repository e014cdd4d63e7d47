#pragma once

#include <filesystem>

namespace nearfit {

/// Throws FileError for a file that need not be read to be refused, before time and memory go into it: one
/// that cannot be opened (InputFile), that is larger than the machine's memory, or that is mostly a hole, as
/// a sparse file is, whose size says nothing.
void checkMeshFile(const std::filesystem::path& file);

}  // namespace nearfit
