#pragma once

#include "core/mesh/readers/reader_input.h"

namespace nearfit {

/// Vertices and faces of a PLY file, text or binary in either byte order; other elements and properties are
/// passed over. Throws FileError, Cancelled.
ReaderResult readPly(const ReaderInput& input);

}  // namespace nearfit
