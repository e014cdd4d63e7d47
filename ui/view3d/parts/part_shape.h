#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include <vtkCellArray.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "core/base/progress.h"
#include "core/mesh/ray_tree.h"
#include "core/scene/part_geometry.h"
#include "ui/view3d/parts/detail_choice.h"

namespace nearfit::ui {

/// A coarse stand-in for a surface, with point normals. Its points are points of the surface, in single precision.
struct DraftSurface {
  vtkSmartPointer<vtkPolyData> surface;
  double cell = 0.0;  ///< Max distance of its points from the surface, in the surface's unit.
};

/// Returns ever coarser stand-ins, each with at most half the triangles of the one before; none for a small
/// surface. O(n log n), also where clustering brings most triangles together at a few points. Any thread.
/// @param finest  Gets the finest stand-in, even if it has too many triangles to be among them; null for a small
///                surface.
std::vector<DraftSurface> draftsOf(vtkPolyData& surface, vtkSmartPointer<vtkPolyData>& finest);

/// A mesh prepared for drawing and picking, in the part's frame [m]. Immutable once made.
struct PartShape {
  vtkSmartPointer<vtkPolyData> surface;  ///< Triangles with point normals; vertices split along sharp edges.
  vtkSmartPointer<vtkPolyData> edges;    ///< Sharp, open and non-manifold edges.
  double edgeLength = 0.0;               ///< Total length of `edges` [m].
  /// `surface` in pieces that each draw quickly; they share its points.
  std::vector<vtkSmartPointer<vtkPolyData>> pieces;
  /// Ever coarser stand-ins with normals, for motion in large scenes; empty for a small mesh.
  std::vector<vtkSmartPointer<vtkPolyData>> drafts;
  std::vector<DetailLevel> levels;  ///< The level of `surface`, then one for each draft.
  /// For a veil over the part: the surface if that is quick to draw, else a fine stand-in. Does not reach beyond the
  /// outline of a convex part; may close gaps of less than a hundredth of the size of a large one.
  vtkSmartPointer<vtkPolyData> veil;
  RayTree rays;  ///< Of the mesh, for picking.
  /// `pieces`, each triangle with the number of its face's colour as cell scalar: 0 for the part's own, i + 1 for
  /// faceColours[i]. Empty if no face has a colour.
  std::vector<vtkSmartPointer<vtkPolyData>> colouredPieces;
  std::vector<CadColour> faceColours;  ///< Those that differ.
  bool hasOwnColour = true;            ///< False if every triangle has a face's colour.
  /// True if no back face is visible from outside.
  bool hidesItsInside = false;
  /// True for the outline of a box in place of a mesh that is not prepared yet: nothing of it can be picked.
  bool isStandIn = false;

  /// Returns the finest draft, or the surface if there is none.
  vtkPolyData* finestDraft() const { return drafts.empty() ? surface.Get() : drafts.front().Get(); }
};

/// Returns triangles as cells of a data set.
vtkSmartPointer<vtkCellArray> cellsOfTriangles(std::span<const Triangle> triangles);
/// Cuts a surface into pieces that each draw quickly, in software OpenGL too; a small one is its own piece. They share
/// its points with their normals and scalars.
std::vector<vtkSmartPointer<vtkPolyData>> quickPiecesOf(vtkPolyData& surface);

/// Builds the shape of a mesh; seconds for millions of triangles. Throws Cancelled.
/// @param coordinateRounding  Max rounding error of a coordinate of the mesh [m]; >= 0.
PartShape makePartShape(const TriangleMesh& mesh, double coordinateRounding = 0.0,
                        const ProgressCallback& progress = {});

/// Returns the edges of a mesh's box, to be drawn until its shape is made. O(1).
PartShape standInFor(const TriangleMesh& mesh);

/// Makes the coloured pieces of a shape, one for each of its pieces. Faces in one colour share its number; a geometry
/// without colours of faces costs nothing.
void addFaceColours(PartShape& shape, const PartGeometry& geometry);

/// Meshes of so many triangles together are prepared before they are shown, which takes about a tenth of a second; of
/// more, boxes are shown first.
constexpr std::size_t kMostAtOnce = 100'000;

/// Caches one shape for each geometry, as long as that geometry exists. Thread-safe: loading
/// fills it before drawing.
class PartShapeCache {
 public:
  /// Returns the shape; the first call for a geometry builds it, which takes seconds for millions of
  /// triangles. Throws Cancelled.
  std::shared_ptr<const PartShape> shapeOf(const PartGeometryPtr& geometry,
                                           const ProgressCallback& progress = {});
  /// Builds the missing shapes of all, or, if their meshes have more than kMostAtOnce triangles, only what stands in for
  /// them: until makePostponed() has built them, shapeOf() returns that. Throws Cancelled.
  void prepare(std::span<const PartGeometryPtr> geometries, const ProgressCallback& progress);
  /// Builds the shapes that prepare() has postponed; shapeOf() returns each from then on. Throws Cancelled.
  void makePostponed(const ProgressCallback& progress = {});
  /// True if shapes are postponed.
  bool hasPostponed() const;

 private:
  struct Entry {
    std::weak_ptr<const PartGeometry> geometry;
    std::shared_ptr<const PartShape> shape;
  };
  static constexpr std::size_t kFewShapes = 16;
  /// Builds a shape, whatever the cache has.
  static std::shared_ptr<const PartShape> made(const PartGeometryPtr& geometry,
                                               const ProgressCallback& progress);
  /// Shape of a geometry, or null. To be called under the lock.
  std::shared_ptr<const PartShape> known(const PartGeometryPtr& geometry) const;
  void keep(const PartGeometryPtr& geometry, std::shared_ptr<const PartShape> shape);
  void makeAll(std::span<const PartGeometryPtr> geometries, const ProgressCallback& progress);
  void dropUnused();

  mutable std::mutex mutex_;
  std::map<const PartGeometry*, Entry> entries_;
  std::size_t nextDrop_ = kFewShapes;  ///< Number of entries at which unused ones are dropped.
  std::vector<std::weak_ptr<const PartGeometry>> postponed_;
};

}  // namespace nearfit::ui
