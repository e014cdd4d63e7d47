#pragma once

#include "core/mesh/readers/reader_input.h"

namespace nearfit {

constexpr std::size_t kStlHeaderBytes = 84, kStlFacetBytes = 50;

/// Number of facets that a binary STL file's header promises; at least kStlHeaderBytes bytes.
std::uint32_t stlFacetCount(std::span<const char> bytes);

/// Facets of a binary STL file, through OpenMesh. Corners with equal coordinates share a vertex.
/// Throws FileError, Cancelled.
ReaderResult readStlBinary(const ReaderInput& input);

}  // namespace nearfit
