#include "ui/tools/measure/measure_bar.h"

#include <QApplication>
#include <QClipboard>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QStringList>
#include <numbers>

#include "ui/widgets/format.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr int kAngleDecimals = 3;

}  // namespace

MeasureBar::MeasureBar(QWidget* view)
    : ViewBar(view, QStringLiteral("measureBar")),
      prompt_(new QLabel(this)),
      hint_(new QLabel(this)),
      copy_(new QPushButton(icon(QStringLiteral("copy")), tr("&Copy"), this)),
      close_(new QPushButton(tr("Close"), this)) {
  prompt_->setObjectName(QStringLiteral("measurePrompt"));
  prompt_->setStyleSheet(QStringLiteral("font-weight: bold"));
  hint_->setObjectName(QStringLiteral("measureHint"));
  hint_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));
  auto *numbers = new QHBoxLayout, *square = new QHBoxLayout;
  for (QHBoxLayout* row : {numbers, square})
    row->setSpacing(6);
  values_ = {addValue(*numbers, "measureDistance", tr("Distance"), tr("Distance between the two points")),
             addValue(*numbers, "measureX", tr("X"), tr("Along the world's X axis, from the first point")),
             addValue(*numbers, "measureY", tr("Y"), tr("Along the world's Y axis, from the first point")),
             addValue(*numbers, "measureZ", tr("Z"), tr("Along the world's Z axis, from the first point")),
             addValue(*square, "measureApart", tr("Perpendicular"),
                      tr("Perpendicular distance between the faces, axes or points that were clicked")),
             addValue(*square, "measureAngle", tr("Angle"), tr("Angle between the faces or axes"))};
  for (int axis = 0; axis < 3; ++axis) {
    values_[static_cast<std::size_t>(axis) + 1].name->setStyleSheet(
        QStringLiteral("font-weight: bold; color: %1").arg(axisColour(axis).name()));
  }
  numbers->addStretch();
  square->addStretch();
  square->addSpacing(10);
  square->addWidget(copy_);
  square->addWidget(close_);
  copy_->setObjectName(QStringLiteral("measureCopy"));
  copy_->setToolTip(tr("Copy the numbers to the clipboard, one per line"));
  close_->setObjectName(QStringLiteral("measureClose"));
  close_->setToolTip(tr("End measuring (Escape)"));
  connect(copy_, &QPushButton::clicked, this, &MeasureBar::copy);
  connect(close_, &QPushButton::clicked, this, &MeasureBar::closed);
  auto* rows = new QVBoxLayout(this);
  rows->setContentsMargins(14, 8, 12, 10);
  rows->setSpacing(3);
  rows->addWidget(prompt_);
  rows->addWidget(hint_);
  rows->addLayout(numbers);
  rows->addLayout(square);
}

MeasureBar::Value MeasureBar::addValue(QHBoxLayout& row, const char* name, const QString& title,
                                       const QString& toolTip) {
  const Value value{new QLabel(title, this), new QLabel(this)};
  value.name->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));
  value.number->setObjectName(QLatin1String(name));
  value.number->setTextInteractionFlags(Qt::TextSelectableByMouse);
  value.number->setContentsMargins(0, 0, 10, 0);
  for (QLabel* label : {value.name, value.number})
    label->setToolTip(toolTip);
  row.addWidget(value.name);
  row.addWidget(value.number);
  return value;
}

void MeasureBar::showPrompt(const QString& prompt, const QString& hint) {
  prompt_->setText(prompt);
  hint_->setText(hint.isEmpty() ? QStringLiteral(" ") : hint);
  place();
}

void MeasureBar::showMeasurement(const std::optional<Measurement>& measurement, LengthUnit unit) {
  std::array<QString, 6> texts;
  if (measurement) {
    const int decimals = measuredDecimals(unit, measurement->distance);
    const glm::dvec3 way = measurement->to - measurement->from;
    const auto length = [&](double metres) { return lengthIn(unit, metres, decimals); };
    texts = {length(measurement->distance), length(way.x), length(way.y), length(way.z)};
    if (measurement->apart) texts[4] = length(*measurement->apart);
    if (measurement->angle) {
      const double degrees = *measurement->angle * 180.0 / std::numbers::pi;
      texts[5] = formatFixed(degrees, kAngleDecimals) + QChar(0xB0);
    }
  }
  bool hasChanged = false;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const bool isShown = !texts[i].isEmpty();
    hasChanged = hasChanged || isShown == values_[i].number->isHidden() ||
                 texts[i].size() != values_[i].number->text().size();
    values_[i].number->setText(texts[i]);
    values_[i].number->setAccessibleName(values_[i].name->text() + QChar(' ') + texts[i]);
    values_[i].name->setVisible(isShown);
    values_[i].number->setVisible(isShown);
  }
  copy_->setEnabled(measurement.has_value());
  if (hasChanged) place();
}

void MeasureBar::copy() const {
  QStringList lines;
  for (const Value& value : values_) {
    if (!value.number->text().isEmpty())
      lines << value.name->text() + QStringLiteral(": ") + value.number->text();
  }
  QApplication::clipboard()->setText(lines.join(QChar('\n')));
}

}  // namespace nearfit::ui
