#include "ui/view3d/measure_mark.h"

#include <QLabel>

#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "ui/view3d/view_picture.h"
#include "ui/view3d/viewport.h"
#include "ui/view3d/vtk/pixel_sizes.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {

MeasureMark::MeasureMark(Viewport& view)
    : view_(view),
      overlay_(&view.overlay()),
      segment_(view.overlay(), colours::kAccent),
      label_(new QLabel(&view)) {
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
  label_->setObjectName(QStringLiteral("measureLabel"));
  label_->setAttribute(Qt::WA_TransparentForMouseEvents);
  setInPictures(*label_);
  label_->setStyleSheet(
      QStringLiteral("#measureLabel { background: rgba(28, 37, 46, 225); color: white; border-radius: 5px; "
                     "padding: 3px 7px; font-weight: 600; }"));
  label_->hide();
}

MeasureMark::~MeasureMark() {
  if (overlay_ == nullptr) return;
  for (Leg& leg : legs_)
    overlay_->RemoveActor(leg.actor);
}

void MeasureMark::show(const Measurement& measurement, const QString& text) {
  shown_ = measurement;
  segment_.show(measurement.from, measurement.to);
  glm::dvec3 corner = measurement.from;
  for (int axis = 0; axis < 3; ++axis) {
    Leg& leg = legs_[static_cast<std::size_t>(axis)];
    leg.line->SetPoint1(corner.x, corner.y, corner.z);
    corner[axis] = measurement.to[axis];
    leg.line->SetPoint2(corner.x, corner.y, corner.z);
    leg.actor->VisibilityOn();
  }
  label_->setText(text);
  label_->adjustSize();
  placeLabel();
}

void MeasureMark::clear() {
  shown_.reset();
  segment_.clear();
  for (Leg& leg : legs_)
    leg.actor->VisibilityOff();
  label_->hide();
}

void MeasureMark::placeLabel() {
  if (!shown_) return;
  const auto middle = view_.projection().pixelOf(0.5 * (shown_->from + shown_->to));
  const QRect room = view_.rect();
  const QPoint at = middle ? QPointF(middle->x, middle->y).toPoint() : QPoint(-1, -1);
  label_->setVisible(room.contains(at));
  label_->move(at - QPoint(label_->width() / 2, label_->height() / 2));
}

}  // namespace nearfit::ui
