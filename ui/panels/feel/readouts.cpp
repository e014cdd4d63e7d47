#include "ui/panels/feel/readouts.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QVBoxLayout>

#include "ui/widgets/theme.h"

namespace nearfit::ui {

Readouts::Readouts(const QString& heading, QWidget* parent)
    : QWidget(parent), layout_(new QVBoxLayout(this)) {
  layout_->setContentsMargins(0, 0, 0, 0);
  layout_->setSpacing(5);
  auto* label = new QLabel(heading, this);
  label->setStyleSheet(QStringLiteral("font-weight: bold; color: #3b4754; padding-top: 8px"));
  label->setIndent(0);
  layout_->addWidget(label);
}

QLabel* Readouts::add(const QString& name, const char* objectName, const QString& toolTip) {
  auto* row = new QHBoxLayout;
  auto* label = new QLabel(name, this);
  label->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));
  auto* value = new QLabel(nothing(), this);
  value->setObjectName(QLatin1String(objectName));
  value->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  label->setToolTip(toolTip);
  value->setToolTip(toolTip);
  row->addWidget(label);
  row->addWidget(value, 1);
  layout_->addLayout(row);
  return value;
}

QLabel* Readouts::addNote(const char* objectName, const QColor& colour) {
  auto* note = new QLabel(this);
  note->setObjectName(QLatin1String(objectName));
  note->setWordWrap(true);
  note->setStyleSheet(QStringLiteral("color: %1").arg(colour.name()));
  layout_->addWidget(note);
  return note;
}

}  // namespace nearfit::ui
