#pragma once

#include <span>

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>

#include "core/haptics/servo_snapshot.h"

namespace nearfit::ui {

/// Draws where the proxy presses on other parts: a disc across the contact's direction, and an arrow along it
/// that grows with its share of the force.
class ContactGlyphs {
 public:
  /// @param renderer  Outlives this.
  explicit ContactGlyphs(vtkRenderer& renderer);

  /// @param contacts  In world coordinates.
  /// @param size      The moving part's diagonal [m].
  void show(std::span<const SnapshotContact> contacts, double size);
  void clear() { show({}, 1.0); }
  void setVisible(bool isVisible);

 private:
  void applyVisibility();

  vtkNew<vtkPolyData> points_;
  vtkNew<vtkActor> rims_, discs_, arrows_;
  bool isVisible_ = true, hasContacts_ = false;
};

}  // namespace nearfit::ui
