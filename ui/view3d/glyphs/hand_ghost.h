#pragma once

#include <memory>
#include <vector>

#include <vtkActor.h>
#include <vtkLineSource.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/math/rigid_transform.h"
#include "core/servo/servo_snapshot.h"
#include "ui/view3d/parts/part_shape.h"

namespace nearfit::ui {

/// Draws the ghost: where the hand wants the moving part, or group, while it stays behind. A translucent copy, and a
/// line from the copy's centre of mass to that of what is copied.
class HandGhost {
 public:
  /// @param parts    Draws the copy; outlives this.
  /// @param overlay  Draws the line, which parts would hide; outlives this.
  HandGhost(vtkRenderer& parts, vtkRenderer& overlay);

  /// A part of what the hand moves, in the frame of the moving part.
  struct Piece {
    std::shared_ptr<const PartShape> shape;
    RigidTransform movingFromPart;
  };
  /// Sets the shapes of all that the hand moves; empty if there is nothing.
  void setPieces(std::vector<Piece> pieces);
  /// Sets the shape of a moving part alone; null if there is none.
  void setShape(std::shared_ptr<const PartShape> shape);
  /// Shows the ghost, unless the hand is too close to the part to tell them apart.
  /// @param size  Diagonal of what the hand moves [m].
  void show(const ServoSnapshot& snapshot, double size);
  void clear();
  void setVisible(bool isVisible);
  /// @param share  Of the usual opacity, for all that this draws; 0 to 1.
  void setOpacity(double share);
  /// Clips the copy, as the part is: keeps the side that the plane's normal points to. Null: whole. Holds a
  /// reference to `cut` and so follows it.
  void setCut(vtkPlane* cut);

  /// Gets the copy's bounds in the world, VTK's order [m]; false while it is not drawn.
  bool visibleBounds(double bounds[6]) const;

 private:
  /// Actors that draw a piece.
  struct Copy {
    vtkNew<vtkActor> surface, edges;
    vtkNew<vtkMatrix4x4> pose;
  };
  void addCopy();
  void applyOpacity();
  void applyVisibility();
  void applyCut();

  vtkRenderer& parts_;
  std::vector<Piece> pieces_;
  std::vector<std::unique_ptr<Copy>> copies_;  ///< One for each piece; more from before are hidden.
  vtkNew<vtkActor> line_;
  vtkNew<vtkLineSource> lead_;
  vtkSmartPointer<vtkPlane> cut_;
  double opacity_ = 1.0;
  bool isVisible_ = true, isAhead_ = false;
};

}  // namespace nearfit::ui
