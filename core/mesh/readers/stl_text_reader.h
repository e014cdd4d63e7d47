#pragma once

#include "core/mesh/readers/reader_input.h"

namespace nearfit {

/// Facets of an ASCII STL file, of all solids in it; keywords in any case, `#` comments allowed, normals
/// passed over. Throws FileError, Cancelled.
ReaderResult readStlText(const ReaderInput& input);

}  // namespace nearfit
