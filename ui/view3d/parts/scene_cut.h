#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkWeakPointer.h>

#include "core/scene/scene.h"
#include "core/section/cut_plane.h"
#include "ui/view3d/parts/part_actor.h"
#include "ui/view3d/parts/part_cap.h"

class QColor;

namespace nearfit::ui {

/// How the view is cut open.
struct ViewCut {
  CutPlane plane;             ///< World frame.
  bool sparesMoving = false;  ///< The moving part stays whole.
  bool operator==(const ViewCut&) const = default;
};

/// The plane that cuts the parts, and the caps of those that can be closed.
class SceneCut {
 public:
  /// @param renderer  Outlives this.
  explicit SceneCut(vtkRenderer& renderer);

  /// Sets the cut; nullopt: all parts are whole.
  void set(const std::optional<ViewCut>& cut) { cut_ = cut; }
  const std::optional<ViewCut>& cut() const noexcept { return cut_; }
  /// True if a part is cut; `isMoving` says that it is the moving part.
  bool cuts(bool isMoving) const noexcept { return cut_ && !(isMoving && cut_->sparesMoving); }
  /// Clipping plane for mappers: what lies on the side of its normal stays.
  vtkPlane* plane() const noexcept { return plane_; }

  /// Makes the cut follow the parts. Before each picture and each pick, call begin(), close() for each cut
  /// part in the scene's order, and end(). Computes only sections of parts that moved against the plane.
  /// @param size  Diagonal of the whole scene [m]; sets the distance of stripes.
  void begin(double size);
  /// Adds or updates the cap of one part.
  void close(const Part& part, const PartActor& actor, const RigidTransform& worldFromPart);
  /// Removes the caps of parts for which close() was not called since begin().
  void end();

  const std::map<PartId, std::unique_ptr<PartCap>>& caps() const noexcept { return caps_; }
  /// Parts that are cut but cannot be closed.
  const std::vector<PartId>& open() const noexcept { return open_; }

 private:
  vtkRenderer& renderer_;
  std::optional<ViewCut> cut_;
  vtkNew<vtkPlane> plane_;
  vtkSmartPointer<vtkTexture> hatch_;
  std::map<PartId, std::unique_ptr<PartCap>> caps_;
  std::vector<PartId> closed_, open_;  ///< In the scene's order, which is by id.
  double spacing_ = 1.0;
};

/// Shows a cutting plane by the outline of a rectangle in it.
class PlaneSheet {
 public:
  /// @param renderer  May be destroyed before this.
  explicit PlaneSheet(vtkRenderer& renderer);
  ~PlaneSheet();
  PlaneSheet(const PlaneSheet&) = delete;
  PlaneSheet& operator=(const PlaneSheet&) = delete;

  /// Shows the outline, as large as `box` seen along the normal; both in the world. `box` must not be empty.
  void show(const CutPlane& plane, const Aabb& box, const QColor& colour);
  void clear();

 private:
  vtkWeakPointer<vtkRenderer> renderer_;  ///< Weak: the view may be destroyed first.
  vtkNew<vtkPoints> corners_;
  vtkNew<vtkPolyData> outline_;
  vtkNew<vtkActor> actor_;
};

}  // namespace nearfit::ui
