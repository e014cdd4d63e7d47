#pragma once

#include "core/import/reader_input.h"

namespace nearfit {

/// Reads vertices and faces of a Wavefront OBJ file. Skips everything else and opens no other file. Handles
/// line continuations, negative indices and extra numbers after a vertex. Throws FileError, Cancelled.
ReaderResult readObj(const ReaderInput& input);

}  // namespace nearfit
