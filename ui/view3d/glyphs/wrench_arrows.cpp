#include "ui/view3d/glyphs/wrench_arrows.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <vtkAppendPolyData.h>
#include <vtkConeSource.h>
#include <vtkLineSource.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyLineSource.h>
#include <vtkProperty.h>
#include <vtkTubeFilter.h>

#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr int kArrowSides = 20;
/// Radius of shafts, radius and length of heads, as fractions of the size.
constexpr double kShaft = 0.018, kHeadRadius = 0.05, kHeadLength = 0.14;
/// Wrenches below this fraction of the device's limit are not drawn.
constexpr double kMin = 1e-4;

void setUp(vtkActor& actor, vtkPolyData& data, const QColor& colour) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(&data);
  mapper->ScalarVisibilityOff();
  actor.SetMapper(mapper);
  actor.PickableOff();
  vtkProperty* property = actor.GetProperty();
  property->SetColor(colour.redF(), colour.greenF(), colour.blueF());
  property->SetAmbient(0.35);
  property->SetDiffuse(0.7);
  property->SetSpecular(0.15);
}

/// Builds a tube along a path, and at its end a cone that points along `direction`.
void buildArrow(vtkPolyData& out, vtkPolyLineSource& path, const glm::dvec3& headStart,
                const glm::dvec3& direction, double size, double headLength) {
  vtkNew<vtkTubeFilter> shaft;
  shaft->SetInputConnection(path.GetOutputPort());
  shaft->SetRadius(kShaft * size);
  shaft->SetNumberOfSides(kArrowSides);
  shaft->CappingOn();
  vtkNew<vtkConeSource> head;
  const glm::dvec3 middle = headStart + 0.5 * headLength * direction;
  head->SetCenter(middle.x, middle.y, middle.z);
  head->SetDirection(direction.x, direction.y, direction.z);
  head->SetHeight(headLength);
  head->SetRadius(headLength * kHeadRadius / kHeadLength);
  head->SetResolution(kArrowSides);
  vtkNew<vtkAppendPolyData> both;
  both->AddInputConnection(shaft->GetOutputPort());
  both->AddInputConnection(head->GetOutputPort());
  both->Update();
  out.ShallowCopy(both->GetOutput());
}

glm::dvec3 anyPerpendicular(const glm::dvec3& axis) {
  const glm::dvec3 other = std::abs(axis.x) < 0.8 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(glm::cross(axis, other));
}

}  // namespace

WrenchArrows::WrenchArrows(vtkRenderer& renderer) {
  setUp(*force_, *forceShape_.Get(), colours::kForce);
  setUp(*torque_, *torqueShape_.Get(), colours::kTorque);
  renderer.AddActor(force_);
  renderer.AddActor(torque_);
  applyVisibility();
}

void WrenchArrows::show(const glm::dvec3& centre, const Wrench& wrench, double size) {
  showForce(centre, wrench.force, size);
  showTorque(centre, wrench.torque, size);
  applyVisibility();
}

void WrenchArrows::clear() {
  hasForce_ = hasTorque_ = false;
  applyVisibility();
}

void WrenchArrows::setVisible(bool isVisible) {
  isVisible_ = isVisible;
  applyVisibility();
}

void WrenchArrows::setOpacity(double share) {
  for (vtkActor* actor : {force_.Get(), torque_.Get()})
    actor->GetProperty()->SetOpacity(share);
}

void WrenchArrows::showForce(const glm::dvec3& centre, const glm::dvec3& force, double size) {
  const double fraction = glm::length(force) / DeviceLimits{}.maxForce;
  hasForce_ = std::isfinite(fraction) && fraction > kMin && size > 0.0;
  if (!hasForce_) return;
  const glm::dvec3 direction = glm::normalize(force);
  const double length = std::min(fraction, 1.0) * size;
  const double headLength = std::min(kHeadLength * size, 0.6 * length);
  const glm::dvec3 headStart = centre + (length - headLength) * direction;
  vtkNew<vtkPolyLineSource> path;
  path->Resize(2);
  path->SetPoint(0, centre.x, centre.y, centre.z);
  path->SetPoint(1, headStart.x, headStart.y, headStart.z);
  buildArrow(*forceShape_.Get(), *path.Get(), headStart, direction, size, headLength);
}

void WrenchArrows::showTorque(const glm::dvec3& centre, const glm::dvec3& torque, double size) {
  const double fraction = glm::length(torque) / DeviceLimits{}.maxTorque;
  hasTorque_ = std::isfinite(fraction) && fraction > kMin && size > 0.0;
  if (!hasTorque_) return;
  const glm::dvec3 axis = glm::normalize(torque);
  const glm::dvec3 u = anyPerpendicular(axis), v = glm::cross(axis, u);
  const double radius = 0.5 * size;
  // The square root keeps small torques of thin parts readable; the legend has the number.
  const double sweep = std::sqrt(std::min(fraction, 1.0)) * 1.7 * std::numbers::pi;
  const double headLength = std::min(kHeadLength * size, 0.6 * sweep * radius);
  const double shaftSweep = sweep - headLength / radius;
  constexpr int kPoints = 49;
  vtkNew<vtkPolyLineSource> path;
  path->Resize(kPoints);
  for (int i = 0; i < kPoints; ++i) {
    const double angle = shaftSweep * i / (kPoints - 1);
    const glm::dvec3 p = centre + radius * (std::cos(angle) * u + std::sin(angle) * v);
    path->SetPoint(i, p.x, p.y, p.z);
  }
  const glm::dvec3 headStart = centre + radius * (std::cos(shaftSweep) * u + std::sin(shaftSweep) * v);
  const double tangent = shaftSweep + 0.5 * headLength / radius;
  buildArrow(*torqueShape_.Get(), *path.Get(), headStart, -std::sin(tangent) * u + std::cos(tangent) * v,
             size, headLength);
}

void WrenchArrows::applyVisibility() {
  force_->SetVisibility(isVisible_ && hasForce_);
  torque_->SetVisibility(isVisible_ && hasTorque_);
}

}  // namespace nearfit::ui
