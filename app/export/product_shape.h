#pragma once

#include <utility>
#include <vector>

#include <TopoDS_Shape.hxx>

#include "core/import/cad_document.h"

namespace nearfit::exporter {

/// Units of OpenCASCADE in a metre: STEP files are written in millimetres, which its tolerances suit.
constexpr double kMillimetresPerMetre = 1000.0;

/// Geometry of a product, in millimetres in the part's frame.
struct ProductShape {
  TopoDS_Shape shape;
  std::vector<std::pair<TopoDS_Shape, CadColour>> faceColours;  ///< Faces that have a colour of their own.
};

/// The same geometry with faces, edges and vertices of its own: OpenCASCADE takes shapes that share these for one.
ProductShape copyOf(const ProductShape& original);

}  // namespace nearfit::exporter
