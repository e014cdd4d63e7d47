#pragma once

#include <vector>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

namespace nearfit::ui {

/// A coarse stand-in for a surface, with point normals.
struct DraftSurface {
  vtkSmartPointer<vtkPolyData> surface;
  double cell = 0.0;  ///< Its points are at most so far from the surface, in the surface's unit.
};

/// Stand-ins coarser and coarser, each with at most half the triangles of the one before; none where the
/// surface is small already. A tenth of a second for a million triangles; any thread.
std::vector<DraftSurface> draftsOf(vtkPolyData& surface);

}  // namespace nearfit::ui
