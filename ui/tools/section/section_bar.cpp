#include "ui/tools/section/section_bar.h"

#include <QCheckBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSlider>
#include <QToolButton>
#include <algorithm>
#include <cmath>

#include "ui/widgets/elided_label.h"
#include "ui/widgets/font_scale.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr double kFarthestPlane = 1e6;  ///< [m]
constexpr int kSliderSteps = 1000, kSliderWidth = 150, kLetterWidth = 30;

/// Makes the checked button stand out.
constexpr const char* kAxisSheet =
    "QToolButton { border: 1px solid #c9d2db; border-radius: 4px; padding: 2px 7px; background: #ffffff; %1 }"
    "QToolButton:hover { background: #e6eef7; border-color: #9fc4ec; }"
    "QToolButton:focus { border-color: #1f73d0; }"
    "QToolButton:checked { background: #d3e5f8; border-color: #1f73d0; }";

}  // namespace

SectionBar::SectionBar(QWidget* view)
    : ViewBar(view, QStringLiteral("sectionBar")),
      slider_(new QSlider(Qt::Horizontal, this)),
      position_(new NumberField(this)),
      flip_(new QPushButton(tr("&Flip"), this)),
      spare_(new QCheckBox(tr("&Moving part uncut"), this)),
      close_(new QPushButton(tr("Close"), this)),
      note_(new ElidedLabel(this)) {
  setUpFields();
  auto* title = new QLabel(tr("Section across"), this);
  title->setStyleSheet(QStringLiteral("font-weight: bold"));
  auto *across = new QHBoxLayout, *where = new QHBoxLayout;
  across->addWidget(title);
  across->addSpacing(4);
  addAxes(*across);
  across->addStretch();
  across->addWidget(spare_);
  for (QWidget* widget : std::initializer_list<QWidget*>{slider_, position_, flip_, close_})
    where->addWidget(widget);
  where->setStretch(0, 1);
  across->setSpacing(4);
  where->setSpacing(8);
  auto* rows = new QVBoxLayout(this);
  rows->setContentsMargins(14, 6, 12, 4);
  rows->setSpacing(4);
  rows->addLayout(across);
  rows->addLayout(where);
  rows->addWidget(note_);
  note_->hide();
}

QToolButton* SectionBar::addAxis(QHBoxLayout& row, const char* name, const QString& text,
                                 const QString& toolTip) {
  auto* button = new QToolButton(this);
  button->setObjectName(QLatin1String(name));
  button->setText(text);
  button->setAccessibleName(tr("Section across %1").arg(text));
  button->setToolTip(toolTip);
  button->setStyleSheet(QString::fromLatin1(kAxisSheet).arg(QString()));
  button->setCheckable(true);
  button->setFocusPolicy(Qt::StrongFocus);
  button->setMinimumHeight(flip_->sizeHint().height());
  row.addWidget(button);
  return button;
}

void SectionBar::addAxes(QHBoxLayout& row) {
  const char* names[] = {"sectionX", "sectionY", "sectionZ"};
  for (int axis = 0; axis < 3; ++axis) {
    const QString letter(QChar('X' + axis));
    QToolButton* button =
        addAxis(row, names[axis], letter, tr("Perpendicular to the world's %1 axis").arg(letter));
    button->setMinimumWidth(forFont(*this, kLetterWidth));
    const QString look = QStringLiteral("font-weight: bold; color: %1;").arg(axisColour(axis).name());
    button->setStyleSheet(QString::fromLatin1(kAxisSheet).arg(look));
    axes_[static_cast<std::size_t>(axis)] = button;
  }
  axes_[3] = addAxis(row, "sectionSight", tr("View"), tr("Perpendicular to the direction of view"));
  axes_[4] = addAxis(row, "sectionFace", tr("Face"), tr("Through a flat face that you click next"));
  int next = 0;
  for (QToolButton* button : axes_) {
    connect(button, &QToolButton::clicked, this, [this, axis = static_cast<SectionAxis>(next++)] {
      const bool wasPicking = isPicking_;
      // Undo the click's own check: the tool that lays the plane sets it.
      showAxis(axis_);
      if (axis == SectionAxis::Face) return emit faceWanted(!wasPicking);
      emit axisChosen(axis);
    });
  }
}

void SectionBar::setUpFields() {
  slider_->setObjectName(QStringLiteral("sectionSlider"));
  slider_->setAccessibleName(tr("Offset of the section"));
  slider_->setToolTip(
      tr("Move the plane through the parts. The arrow in the view moves it too; the rings tilt it."));
  slider_->setRange(0, kSliderSteps);
  slider_->setPageStep(kSliderSteps / 20);
  slider_->setMinimumWidth(kSliderWidth);
  position_->setObjectName(QStringLiteral("sectionPosition"));
  position_->setAccessibleName(tr("Offset of the section"));
  position_->setLength(4);
  position_->setActingAtOnce();
  position_->setQuantityRange(-kFarthestPlane, kFarthestPlane);
  position_->setQuantityStep(1e-3);
  position_->setToolTip(
      tr("Offset of the plane: along an axis from the world's origin, otherwise from where it was placed"));
  flip_->setObjectName(QStringLiteral("sectionFlip"));
  flip_->setToolTip(tr("Cut away the other side"));
  spare_->setObjectName(QStringLiteral("sectionSpare"));
  spare_->setToolTip(tr("Leave the moving part uncut, to see it inside the others"));
  close_->setObjectName(QStringLiteral("sectionClose"));
  close_->setToolTip(tr("Show the parts whole again (Esc)"));
  note_->setObjectName(QStringLiteral("sectionNote"));
  note_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kWarning.name()));
  // It comes and goes with pictures: the view must not change its size while one is drawn.
  QSizePolicy policy = note_->sizePolicy();
  policy.setRetainSizeWhenHidden(true);
  note_->setSizePolicy(policy);
  note_->setFixedHeight(note_->fontMetrics().height());
  connect(slider_, &QSlider::valueChanged, this, [this](int value) {
    emit positionEdited(reach_.first + (reach_.second - reach_.first) * value / kSliderSteps);
  });
  connect(position_, &NumberField::quantityEdited, this, &SectionBar::positionEdited);
  connect(flip_, &QPushButton::clicked, this, &SectionBar::flipped);
  connect(spare_, &QCheckBox::toggled, this, &SectionBar::sparingEdited);
  connect(close_, &QPushButton::clicked, this, &SectionBar::closed);
}

void SectionBar::showAxis(std::optional<SectionAxis> axis) {
  axis_ = axis;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const auto own = static_cast<SectionAxis>(i);
    axes_[i]->setChecked(isPicking_ ? own == SectionAxis::Face : axis == own);
  }
}

void SectionBar::showPicking(bool isPicking) {
  isPicking_ = isPicking;
  showAxis(axis_);
}

void SectionBar::showPosition(double position, const std::pair<double, double>& reach) {
  reach_ = reach;
  const double length = reach.second - reach.first;
  const double share = length > 0.0 ? (position - reach.first) / length : 0.5;
  const QSignalBlocker blocker(slider_);
  slider_->setValue(static_cast<int>(std::lround(kSliderSteps * std::clamp(share, 0.0, 1.0))));
  position_->showQuantity(position);
}

bool SectionBar::isMovingSpared() const {
  return spare_->isChecked();
}

void SectionBar::spareMoving(bool isSpared) {
  const QSignalBlocker blocker(spare_);
  spare_->setChecked(isSpared);
}

void SectionBar::showNote(const QString& note) {
  if (note_->text() == note) return;
  note_->setText(note);
  note_->setToolTip(note);
  note_->setVisible(!note.isEmpty());
}

}  // namespace nearfit::ui
