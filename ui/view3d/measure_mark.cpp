#include "ui/view3d/measure_mark.h"

#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "ui/view3d/spot_label.h"
#include "ui/view3d/viewport.h"
#include "ui/view3d/vtk/pixel_sizes.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {

MeasureMark::MeasureMark(Viewport& view)
    : overlay_(&view.overlay()),
      segment_(view.overlay(), colours::kAccent),
      label_(new SpotLabel(view, QStringLiteral("measureLabel"))) {
  for (int axis = 0; axis < 3; ++axis) {
    Leg& leg = legs_[static_cast<std::size_t>(axis)];
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(leg.line->GetOutputPort());
    leg.actor->SetMapper(mapper);
    leg.actor->PickableOff();
    leg.actor->VisibilityOff();
    const QColor colour = axisColour(axis);
    vtkProperty& look = *leg.actor->GetProperty();
    look.LightingOff();
    look.SetColor(colour.redF(), colour.greenF(), colour.blueF());
    look.SetLineWidth(devicePixels(2.0F));
    overlay_->AddActor(leg.actor);
  }
}

MeasureMark::~MeasureMark() {
  if (overlay_ == nullptr) return;
  for (Leg& leg : legs_)
    overlay_->RemoveActor(leg.actor);
}

void MeasureMark::show(const Measurement& measurement, const QString& text) {
  segment_.show(measurement.from, measurement.to);
  glm::dvec3 corner = measurement.from;
  for (int axis = 0; axis < 3; ++axis) {
    Leg& leg = legs_[static_cast<std::size_t>(axis)];
    leg.line->SetPoint1(corner.x, corner.y, corner.z);
    corner[axis] = measurement.to[axis];
    leg.line->SetPoint2(corner.x, corner.y, corner.z);
    leg.actor->VisibilityOn();
  }
  label_->showAt(0.5 * (measurement.from + measurement.to), text);
}

void MeasureMark::clear() {
  segment_.clear();
  for (Leg& leg : legs_)
    leg.actor->VisibilityOff();
  label_->end();
}

}  // namespace nearfit::ui
