#include "ui/files/unit_dialog.h"

#include <QComboBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>
#include <array>

#include "ui/widgets/names.h"
#include "ui/widgets/preferences.h"

namespace nearfit::ui {
namespace {

struct Unit {
  const char* name;
  double metres;
};
constexpr std::array<Unit, 6> kUnits = {{{QT_TRANSLATE_NOOP("Unit", "Micrometres"), 1e-6},
                                         {QT_TRANSLATE_NOOP("Unit", "Tenths of a millimetre"), 1e-4},
                                         {QT_TRANSLATE_NOOP("Unit", "Millimetres"), 1e-3},
                                         {QT_TRANSLATE_NOOP("Unit", "Centimetres"), 1e-2},
                                         {QT_TRANSLATE_NOOP("Unit", "Inches"), 0.0254},
                                         {QT_TRANSLATE_NOOP("Unit", "Metres"), 1.0}}};

}  // namespace

std::optional<double> askForUnit(const QString& what, QWidget* parent) {
  QDialog dialog(parent);
  dialog.setObjectName(QStringLiteral("unitDialog"));
  dialog.setWindowTitle(QObject::tr("Unit of length"));
  auto* question = new QLabel(
      QObject::tr("These formats store no unit. What is the unit of %1?").arg(breakable(shortName(what))),
      &dialog);
  question->setWordWrap(true);
  auto* box = new QComboBox(&dialog);
  box->setObjectName(QStringLiteral("unit"));
  box->setAccessibleName(QObject::tr("Unit of length"));
  for (const Unit& unit : kUnits) {
    box->addItem(QObject::tr(unit.name), unit.metres);
    if (unit.metres == Preferences::metresPerUnit()) box->setCurrentIndex(box->count() - 1);
  }
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, &dialog);
  buttons->button(QDialogButtonBox::Ok)->setText(QObject::tr("Add"));
  QObject::connect(buttons, &QDialogButtonBox::accepted, &dialog, &QDialog::accept);
  QObject::connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
  auto* layout = new QVBoxLayout(&dialog);
  layout->addWidget(question);
  layout->addWidget(box);
  layout->addWidget(buttons);
  dialog.setMinimumWidth(360);
  if (dialog.exec() != QDialog::Accepted) return std::nullopt;
  const double metresPerUnit = box->currentData().toDouble();
  Preferences::setMetresPerUnit(metresPerUnit);
  return metresPerUnit;
}

}  // namespace nearfit::ui
