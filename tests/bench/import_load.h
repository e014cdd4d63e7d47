#pragma once

#include <filesystem>

#include "tests/bench/import_run.h"

namespace nearfit::bench {

/// Reads a document as the window and the command line do, places its parts in a scene, and prepares all that the
/// servo needs of it, the first part in hand. Memory is that of the whole process: for a process that does only this.
/// Throws what loadDocument() throws.
ImportRun loadToFeel(const std::filesystem::path& file);

}  // namespace nearfit::bench
