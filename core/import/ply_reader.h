#pragma once

#include "core/import/reader_input.h"

namespace nearfit {

/// Reads vertices and faces of a PLY file, text or binary in either byte order. Skips other elements and
/// properties. Throws FileError, Cancelled.
ReaderResult readPly(const ReaderInput& input);

}  // namespace nearfit
