#pragma once

#include "core/import/reader_input.h"

namespace nearfit {

/// Sizes in a binary STL file [bytes]; the header includes the facet count.
constexpr std::size_t kStlHeaderBytes = 84, kStlFacetBytes = 50;

/// Number of facets according to the header of a binary STL file. `bytes` has at least kStlHeaderBytes.
std::uint32_t stlFacetCount(std::span<const char> bytes);

/// Reads the facets of a binary STL file, each with three vertices of its own; MeshBuilder welds them. Throws FileError, Cancelled.
ReaderResult readStlBinary(const ReaderInput& input);

}  // namespace nearfit
