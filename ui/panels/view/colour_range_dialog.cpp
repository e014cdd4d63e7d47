#include "ui/panels/view/colour_range_dialog.h"

#include <QDialog>
#include <QDialogButtonBox>
#include <QFormLayout>

#include "ui/widgets/number_field.h"

namespace nearfit::ui {

std::optional<double> askForColourRange(double now, QWidget* parent) {
  constexpr double kMin = 1e-6, kMax = 10.0;  // [m]
  QDialog dialog(parent);
  dialog.setObjectName(QStringLiteral("colourRangeDialog"));
  dialog.setWindowTitle(QObject::tr("Colour range"));
  auto* field = new NumberField(&dialog);
  field->setObjectName(QStringLiteral("colourRange"));
  field->setAccessibleName(QObject::tr("Colour range"));
  field->setLength(4);
  field->setQuantityRange(kMin, kMax);
  field->showQuantity(now);
  field->setHelp(QObject::tr("Minima at this distance or beyond are blue; contact is red"));
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, &dialog);
  QObject::connect(buttons, &QDialogButtonBox::accepted, &dialog, &QDialog::accept);
  QObject::connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
  auto* layout = new QFormLayout(&dialog);
  layout->addRow(QObject::tr("Blue from:"), field);
  layout->addRow(buttons);
  if (dialog.exec() != QDialog::Accepted) return std::nullopt;
  field->settle();
  return field->quantity();
}

}  // namespace nearfit::ui
