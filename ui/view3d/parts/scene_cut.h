#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <vtkNew.h>
#include <vtkPlane.h>

#include "core/scene/scene.h"
#include "ui/view3d/parts/part_actor.h"
#include "ui/view3d/parts/part_cap.h"

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

}  // namespace nearfit::ui
