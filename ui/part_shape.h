#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStaticCellLocator.h>

#include "core/progress.h"
#include "core/scene/part_geometry.h"
#include "ui/detail/detail_choice.h"

namespace nearfit::ui {

/// A mesh as the graphics card wants it, in the part's frame [m]. Not changed once made.
struct PartShape {
  vtkSmartPointer<vtkPolyData> surface;  ///< Triangles with point normals, split along sharp edges.
  vtkSmartPointer<vtkPolyData> edges;    ///< Sharp, open and non-manifold edges.
  double edgeLength = 0.0;               ///< Of all of them [m].
  /// The surface again, in pieces that are drawn in a moment each; they share its points.
  std::vector<vtkSmartPointer<vtkPolyData>> pieces;
  /// For what moves where there is too much to draw: coarser and coarser, with normals; none of a small mesh.
  std::vector<vtkSmartPointer<vtkPolyData>> drafts;
  std::vector<DetailLevel> levels;  ///< The surface's, then each draft's.
  /// Search structure for picking, of the surface. Not for several threads at once.
  vtkSmartPointer<vtkStaticCellLocator> locator;
  /// Nobody outside sees a triangle from behind.
  bool hidesItsInside = false;

  /// Good enough for what is drawn as a veil.
  vtkPolyData* finestDraft() const { return drafts.empty() ? surface.Get() : drafts.front().Get(); }
};

/// Throws Cancelled.
PartShape makePartShape(const TriangleMesh& mesh, const ProgressCallback& progress = {});

/// One shape for each geometry while anyone holds that geometry. Any thread: loading fills it ahead of
/// drawing.
class PartShapeCache {
 public:
  /// Makes the shape at the first call for a geometry: seconds for millions of triangles.
  /// Throws Cancelled.
  std::shared_ptr<const PartShape> shapeOf(const PartGeometryPtr& geometry,
                                           const ProgressCallback& progress = {});
  /// Makes those of all of them. Throws Cancelled.
  void prepare(std::span<const PartGeometryPtr> geometries, const ProgressCallback& progress);

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
