#pragma once

#include <memory>

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkRenderer.h>
#include <vtkStaticCellLocator.h>

#include "core/scene/scene.h"
#include "ui/part_shape.h"

namespace nearfit::ui {

/// How a part is drawn besides its own colour.
struct PartLook {
  bool isMoving = false;
  bool isSelected = false;
  bool isTranslucent = false;
  bool isOverlapping = false;  ///< With the moving part, which so cannot feel it.
  bool hasEdges = true;
  double opacity = 1.0;  ///< Of the part itself.
  bool operator==(const PartLook&) const = default;
};

/// One part in the view: surface and edge lines. In the renderer from construction to destruction. While it
/// is selected, a faint veil and its edges are drawn over everything else, so that it is seen behind other
/// parts.
class PartActor {
 public:
  /// @param over  May be null: then nothing shows through.
  PartActor(vtkRenderer& renderer, std::shared_ptr<const PartShape> shape, vtkRenderer* over = nullptr);
  ~PartActor();
  PartActor(const PartActor&) = delete;
  PartActor& operator=(const PartActor&) = delete;

  void setPose(const RigidTransform& worldFromPart);
  void setAppearance(const Colour& colour, bool isVisible, const PartLook& look);

  const PartShape* shape() const noexcept { return shape_.get(); }
  vtkActor* surface() const noexcept { return surface_; }
  /// Search structure for picking, built at the first call.
  vtkStaticCellLocator* locator();

 private:
  void setThrough(bool isThrough);

  vtkRenderer& renderer_;
  std::shared_ptr<const PartShape> shape_;
  vtkRenderer* over_;
  vtkNew<vtkActor> surface_, edges_;
  /// While it is selected, in over_.
  vtkSmartPointer<vtkActor> veil_, veilEdges_;
  vtkNew<vtkMatrix4x4> pose_;
  vtkSmartPointer<vtkStaticCellLocator> locator_;
};

}  // namespace nearfit::ui
