#pragma once

#include <map>
#include <memory>
#include <mutex>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "core/scene/part_geometry.h"

namespace nearfit::ui {

/// A mesh as the graphics card wants it, in the part's frame [m]. Not changed once made.
struct PartShape {
  vtkSmartPointer<vtkPolyData> surface;  ///< Triangles with point normals, split along sharp edges.
  vtkSmartPointer<vtkPolyData> edges;    ///< Sharp, open and non-manifold edges.
};

PartShape makePartShape(const TriangleMesh& mesh);

/// One shape for each geometry while anyone holds that geometry. Any thread: loading fills it ahead of
/// drawing.
class PartShapeCache {
 public:
  /// Makes the shape at the first call for a geometry: seconds for millions of triangles.
  std::shared_ptr<const PartShape> shapeOf(const PartGeometryPtr& geometry);

 private:
  struct Entry {
    std::weak_ptr<const PartGeometry> geometry;
    std::shared_ptr<const PartShape> shape;
  };
  void dropUnused();

  std::mutex mutex_;
  std::map<const PartGeometry*, Entry> entries_;
};

}  // namespace nearfit::ui
