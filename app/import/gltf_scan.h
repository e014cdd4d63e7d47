#pragma once

#include <string>
#include <vector>

#include "app/import/import_job.h"

namespace nearfit::importer {

/// Looks through a glTF file, text or binary, for what a reader would follow without end or out of its folder: nodes
/// that contain themselves, nodes placed a billion times, buffers elsewhere; and for extensions without which it cannot
/// be read. Returns the names of the files that its buffers lie in. Throws FileError.
std::vector<std::string> scanGltf(const ImportJob& job);

}  // namespace nearfit::importer
