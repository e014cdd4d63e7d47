#pragma once

#include "core/import/reader_input.h"

namespace nearfit {

/// Reads the facets of all solids in an ASCII STL file. Keywords may have any case, `#` starts a comment,
/// normals are skipped. Throws FileError, Cancelled.
ReaderResult readStlText(const ReaderInput& input);

}  // namespace nearfit
