#pragma once

#include <cstddef>

#include "app/export/product_shape.h"
#include "core/import/cad_document.h"

namespace nearfit::exporter {

/// Max planar faces that triangles may become in a file: each takes some 10 kB of memory and 2 kB of the file, and CAD
/// programs are slow by then.
constexpr std::size_t kMaxFacets = 100'000;

/// Triangles as planar faces that share edges and vertices. Those of one flat and colour are one face, a polygon with
/// holes; triangles without area are left out. Closed components become solids, those inside out cavities of the smallest
/// solid around them; others become shells.
/// @param shape   Checked (checkDocument()), in metres.
/// @param facets  Faces so far; raised by those that are made.
/// Throws Error if there are more than kMaxFacets, or nothing is left.
ProductShape facetedShape(const CadShape& shape, std::size_t& facets);

}  // namespace nearfit::exporter
