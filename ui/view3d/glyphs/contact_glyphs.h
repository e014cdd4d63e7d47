#pragma once

#include <span>

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>

#include "core/servo/servo_snapshot.h"

namespace nearfit::ui {

/// Draws where the proxy presses on other parts: a disc perpendicular to the contact direction and an arrow
/// along it, which grows with the contact's share of the force.
class ContactGlyphs {
 public:
  /// @param renderer  Outlives this.
  explicit ContactGlyphs(vtkRenderer& renderer);

  /// @param contacts  World frame; empty hides all.
  /// @param size      Diagonal of the moving part [m].
  void show(std::span<const SnapshotContact> contacts, double size);
  void clear() { show({}, 1.0); }
  void setVisible(bool isVisible);
  /// @param share  Of the usual opacity, for all that this draws; 0 to 1.
  void setOpacity(double share);

 private:
  void applyVisibility();

  vtkNew<vtkPolyData> points_;
  vtkNew<vtkActor> rims_, discs_, arrows_;
  bool isVisible_ = true, hasContacts_ = false;
};

}  // namespace nearfit::ui
