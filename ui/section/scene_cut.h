#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <vtkNew.h>
#include <vtkPlane.h>

#include "core/scene/scene.h"
#include "ui/part_actor.h"
#include "ui/section/part_cap.h"

namespace nearfit::ui {

/// How the view is cut open.
struct ViewCut {
  CutPlane plane;             ///< In the world.
  bool sparesMoving = false;  ///< The moving part stays whole.
  bool operator==(const ViewCut&) const = default;
};

/// The plane that parts are cut by, and what closes the cut, as far as the parts are closed.
class SceneCut {
 public:
  /// @param renderer  Outlives this.
  explicit SceneCut(vtkRenderer& renderer);

  /// Nothing: all parts are whole.
  void set(const std::optional<ViewCut>& cut) { cut_ = cut; }
  const std::optional<ViewCut>& cut() const noexcept { return cut_; }
  bool cuts(bool isMoving) const noexcept { return cut_ && !(isMoving && cut_->sparesMoving); }
  /// For mappers: what lies on the side of its normal stays.
  vtkPlane* plane() const noexcept { return plane_; }

  /// Before each picture and each pick: follows parts that came, left, moved or look differently. Cuts only
  /// what has moved against the plane.
  /// @param size  Of the whole scene [m]: stripes are as wide as suits it.
  void begin(double size);
  void close(const Part& part, const PartActor& actor, const RigidTransform& worldFromPart);
  /// Takes the caps of those that were not closed since begin().
  void end();

  const std::map<PartId, std::unique_ptr<PartCap>>& caps() const noexcept { return caps_; }
  /// Parts that are cut and cannot be closed.
  const std::vector<PartId>& open() const noexcept { return open_; }

 private:
  vtkRenderer& renderer_;
  std::optional<ViewCut> cut_;
  vtkNew<vtkPlane> plane_;
  vtkSmartPointer<vtkTexture> hatch_;
  std::map<PartId, std::unique_ptr<PartCap>> caps_;
  std::vector<PartId> closed_, open_;  ///< In the scene's order, which is by their ids.
  double spacing_ = 1.0;
};

}  // namespace nearfit::ui
