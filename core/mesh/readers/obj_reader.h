#pragma once

#include "core/mesh/readers/reader_input.h"

namespace nearfit {

/// Vertices and faces of a Wavefront OBJ file; everything else in it is passed over, and no other file is
/// opened. Understands line continuations, negative indices, extra numbers behind a vertex. Throws FileError,
/// Cancelled.
ReaderResult readObj(const ReaderInput& input);

}  // namespace nearfit
