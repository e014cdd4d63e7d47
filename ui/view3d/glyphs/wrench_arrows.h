#pragma once

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>

#include "core/servo/servo_tick.h"

namespace nearfit::ui {

/// Draws force (a straight arrow) and torque (an arc with a head, right-handed about its axis) at the moving
/// part's centre of mass.
class WrenchArrows {
 public:
  /// @param renderer  Outlives this.
  explicit WrenchArrows(vtkRenderer& renderer);

  /// @param centre  Centre of mass, where the force starts; world [m].
  /// @param wrench  World frame.
  /// @param size    Length of the arrow at max force, and diameter of the torque's arc [m].
  void show(const glm::dvec3& centre, const Wrench& wrench, double size);
  void clear();
  void setVisible(bool isVisible);
  /// @param share  Of the usual opacity, for all that this draws; 0 to 1.
  void setOpacity(double share);

 private:
  void showForce(const glm::dvec3& centre, const glm::dvec3& force, double size);
  void showTorque(const glm::dvec3& centre, const glm::dvec3& torque, double size);
  void applyVisibility();

  vtkNew<vtkPolyData> forceShape_, torqueShape_;
  vtkNew<vtkActor> force_, torque_;
  bool isVisible_ = true, hasForce_ = false, hasTorque_ = false;
};

}  // namespace nearfit::ui
