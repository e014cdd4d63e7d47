#pragma once

#include <vector>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

namespace nearfit::ui {

/// A coarse stand-in for a surface, with point normals.
struct DraftSurface {
  vtkSmartPointer<vtkPolyData> surface;
  double cell = 0.0;  ///< Max distance of its points from the surface, in the surface's unit.
};

/// Returns ever coarser stand-ins, each with at most half the triangles of the one before; none for a small
/// surface. Takes 0.1 s for a million triangles. Any thread.
std::vector<DraftSurface> draftsOf(vtkPolyData& surface);

}  // namespace nearfit::ui
