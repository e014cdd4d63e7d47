#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <vtkLookupTable.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "core/report/clearance_map.h"

namespace nearfit::ui {

/// A surface to be drawn in the colours of its clearances, in the part's frame [m]. Immutable once made.
struct ColouredSurface {
  /// With normals as the part is shaded, and the clearance as point scalars [m]; beyond the range these are
  /// kBeyond times the range. Each piece draws quickly.
  std::vector<vtkSmartPointer<vtkPolyData>> pieces;
  /// Same, without triangles whose corners are all beyond the range: for a part that is seen through.
  std::vector<vtkSmartPointer<vtkPolyData>> nearPieces;
  std::size_t triangles = 0;
  double range = 0.0;  ///< [m]

  static constexpr double kBeyond = 1.5;
};

/// Prepares a mapped surface for drawing. Any thread; a second for millions of samples.
std::shared_ptr<const ColouredSurface> colouredSurface(const MappedSurface& mapped, double range);

/// Sets the colours of clearances from 0 to the range: kOverlapColour below, the part's own beyond.
/// @param isStale  Colours are pale, as they are of a former pose.
void setClearanceColours(vtkLookupTable& table, double range, const Colour& own, bool isStale);

}  // namespace nearfit::ui
