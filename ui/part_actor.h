#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

#include "core/scene/scene.h"
#include "ui/detail/shape_mappers.h"

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
  PartActor(vtkRenderer& renderer, std::shared_ptr<ShapeMappers> mappers, vtkRenderer* over = nullptr);
  ~PartActor();
  PartActor(const PartActor&) = delete;
  PartActor& operator=(const PartActor&) = delete;

  /// True when it was elsewhere before.
  bool setPose(const RigidTransform& worldFromPart);
  /// True when it looked otherwise before.
  bool setAppearance(const Colour& colour, bool isVisible, const PartLook& look);
  /// How large it is seen: where its edges would cover it they are left out, of what is selected too.
  void setScale(double pixelsPerMetre);
  /// One of the shape's levels. Edges are drawn with the mesh itself alone.
  void setLevel(std::size_t level);
  /// Of the same shape: cut open, or whole again.
  void setMappers(std::shared_ptr<ShapeMappers> mappers);
  /// While a picture of it is kept it need not be drawn.
  void setKept(bool isKept);

  const PartShape& shape() const noexcept { return *mappers_->shape(); }
  const ShapeMappers& mappers() const noexcept { return *mappers_; }
  bool isVisible() const noexcept { return isVisible_; }
  bool isOpaque() const noexcept;
  std::size_t level() const noexcept { return level_; }
  bool isKept() const noexcept { return isKept_; }
  /// Of the mesh itself, in the world, as VTK has them [m].
  void bounds(double bounds[6]) const;
  /// What draws it as it is, piece by piece.
  void addTo(std::vector<vtkProp*>& props) const;
  const std::vector<vtkSmartPointer<vtkActor>>& pieces() const noexcept { return pieces_; }
  vtkProperty& look() const noexcept { return *look_.Get(); }
  vtkProperty& edgeLook() const noexcept { return *edges_->GetProperty(); }

 private:
  void showPieces();
  void hideBackFaces();
  void setThrough(bool isThrough);

  vtkRenderer& renderer_;
  std::shared_ptr<ShapeMappers> mappers_;
  vtkRenderer* over_;
  std::vector<vtkSmartPointer<vtkActor>> pieces_;  ///< The first also draws drafts.
  vtkNew<vtkProperty> look_;
  vtkNew<vtkActor> edges_;
  /// While it is selected, in over_.
  vtkSmartPointer<vtkActor> veil_, veilEdges_;
  vtkNew<vtkMatrix4x4> pose_;
  std::optional<RigidTransform> worldFromPart_;
  std::optional<PartLook> shownLook_;
  Colour colour_;
  std::size_t level_ = 0;
  bool isVisible_ = true, isKept_ = false;
  bool areEdgesApart_ = true;  ///< As large as it is seen, edges do not run into one another.
};

}  // namespace nearfit::ui
