#include "ui/panels/replay/path_dialogs.h"

#include <QCheckBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "ui/widgets/font_scale.h"
#include "ui/widgets/length_unit.h"
#include "ui/widgets/number_field.h"

namespace nearfit::ui {
namespace {

/// Limits of lengths here [m]: below, rounding is coarser; above, nothing of the motion would be left.
constexpr double kMinPathLength = 1e-12, kMaxPathLength = 10.0;
/// First values of thinning and smoothing [m]: what a hand does not mean.
constexpr double kFirstThin = 1e-4, kFirstSmooth = 5e-4;
constexpr int kPathDecimals = 6, kTimeDecimals = 3;

/// Figures of a separation that is offered: as many as formatRoundLength() says of the one that was proven.
constexpr int kSeparationFigures = 4;
/// Share of the last digit by which a number of them is rounded: it must not become a digit less.
constexpr double kDigitRounding = 1e-6;

/// A separation as it is offered [m]: rounded down to the digits that are shown in the user's unit, so that no more is read
/// than is proven. More than half of it is left, which far scenes need. One below the last digit stays as it is.
double offeredSeparation(double separation) {
  const LengthUnit unit = shownLengthUnit();
  const double number = separation / metresOf(unit);
  if (!(number > 0.0) || !std::isfinite(number)) return separation;
  const int after = kSeparationFigures - 1 - static_cast<int>(std::floor(std::log10(number)));
  const double perUnit = std::pow(10.0, std::min(after, kPathDecimals + extraDecimals(unit)));
  const double digits = std::floor(number * perUnit + kDigitRounding);
  return digits > 0.0 ? digits / perUnit * metresOf(unit) : separation;
}

NumberField* pathLengthField(QWidget* parent, const char* name, double shown, const QString& help) {
  auto* field = new NumberField(parent);
  field->setObjectName(QLatin1String(name));
  field->setTrimmed(true);
  field->setLength(kPathDecimals);
  field->setQuantityRange(kMinPathLength, kMaxPathLength);
  field->setHelp(help);
  field->showQuantity(shown);
  return field;
}

NumberField* timeField(QWidget* parent, const char* name, double shown, double duration,
                       const QString& help) {
  auto* field = new NumberField(parent);
  field->setObjectName(QLatin1String(name));
  field->setUnit(QStringLiteral(" s"));
  field->setDecimals(kTimeDecimals);
  field->setQuantityRange(0.0, duration);
  field->setHelp(help);
  field->showQuantity(shown);
  return field;
}

/// Adds buttons that accept the dialog once each field can be read.
void addPathButtons(QDialog& dialog, QVBoxLayout& layout, const QString& accept,
                    const QList<NumberField*>& fields) {
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, &dialog);
  buttons->button(QDialogButtonBox::Ok)->setText(accept);
  QObject::connect(buttons, &QDialogButtonBox::accepted, &dialog, [&dialog, fields] {
    for (NumberField* field : fields) {
      field->settle();
      if (field->isEnabled() && field->isFaulty()) return;
    }
    dialog.accept();
  });
  QObject::connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
  layout.addWidget(buttons);
}

/// Asks for one length.
std::optional<double> askForLength(const char* name, const QString& title, const QString& label,
                                   const QString& help, const QString& accept, double offered,
                                   QWidget* parent) {
  QDialog dialog(parent);
  dialog.setObjectName(QLatin1String(name));
  dialog.setWindowTitle(title);
  dialog.setMinimumWidth(forFont(dialog, 320));
  auto* text = new QLabel(help, &dialog);
  text->setWordWrap(true);
  auto* field = pathLengthField(&dialog, "pathLength", offered, help);
  auto* form = new QFormLayout;
  form->addRow(label, field);
  auto* layout = new QVBoxLayout(&dialog);
  layout->addWidget(text);
  layout->addLayout(form);
  addPathButtons(dialog, *layout, accept, {field});
  return dialog.exec() == QDialog::Accepted ? std::optional(field->quantity()) : std::nullopt;
}

}  // namespace

std::optional<PathWishes> askForPathWishes(std::pair<double, double> range, double duration,
                                           double separation, QWidget* parent) {
  QDialog dialog(parent);
  dialog.setObjectName(QStringLiteral("pathDialog"));
  dialog.setWindowTitle(QObject::tr("Save as path"));
  dialog.setMinimumWidth(forFont(dialog, 360));
  auto* from = timeField(&dialog, "pathFrom", range.first, duration, QObject::tr("Start of the path"));
  auto* to = timeField(&dialog, "pathTo", range.second, duration, QObject::tr("End of the path"));
  auto* thins = new QCheckBox(QObject::tr("&Thin, at most"), &dialog);
  auto* smooths = new QCheckBox(QObject::tr("&Smooth, at most"), &dialog);
  thins->setObjectName(QStringLiteral("pathThins"));
  smooths->setObjectName(QStringLiteral("pathSmooths"));
  thins->setToolTip(QObject::tr("Leave out poses where the way between others says the same"));
  smooths->setToolTip(QObject::tr("Take the hand's tremor out"));
  auto* thin = pathLengthField(&dialog, "pathThin", kFirstThin,
                               QObject::tr("No point of the part comes farther than this from the motion"));
  auto* smooth = pathLengthField(&dialog, "pathSmooth", kFirstSmooth,
                                 QObject::tr("No point of a pose moves farther than this"));
  auto* kept = pathLengthField(&dialog, "pathSeparation", offeredSeparation(separation),
                               QObject::tr("Distance from other parts that thinning and smoothing keep; "
                                           "where it is not proven, the motion stays as it is"));
  thins->setChecked(true);
  const auto follow = [=] {
    thin->setEnabled(thins->isChecked());
    smooth->setEnabled(smooths->isChecked());
    kept->setEnabled(thins->isChecked() || smooths->isChecked());
  };
  QObject::connect(thins, &QCheckBox::toggled, &dialog, follow);
  QObject::connect(smooths, &QCheckBox::toggled, &dialog, follow);
  follow();
  auto* form = new QFormLayout;
  form->addRow(QObject::tr("&From"), from);
  form->addRow(QObject::tr("T&o"), to);
  form->addRow(thins, thin);
  form->addRow(smooths, smooth);
  form->addRow(QObject::tr("&Keep from other parts"), kept);
  auto* layout = new QVBoxLayout(&dialog);
  layout->addLayout(form);
  addPathButtons(dialog, *layout, QObject::tr("Save…"), {from, to, thin, smooth, kept});
  if (dialog.exec() != QDialog::Accepted) return std::nullopt;
  PathWishes wishes{from->quantity(), to->quantity(), {}, {}, kept->quantity()};
  if (thins->isChecked()) wishes.thin = thin->quantity();
  if (smooths->isChecked()) wishes.smooth = smooth->quantity();
  return wishes;
}

std::optional<double> askForSeparation(double offered, QWidget* parent) {
  return askForLength("certifyDialog", QObject::tr("Certify"), QObject::tr("&Separation"),
                      QObject::tr("Prove that the part keeps this distance from all other visible parts, "
                                  "everywhere on the path and not only at its poses"),
                      QObject::tr("Certify"), offeredSeparation(offered), parent);
}

std::optional<double> askForResolution(double offered, QWidget* parent) {
  return askForLength("sweptDialog", QObject::tr("Swept volume"), QObject::tr("&Resolution"),
                      QObject::tr("The mesh holds all that the part passes, and is nowhere farther than this "
                                  "from it; a finer one takes longer"),
                      QObject::tr("Export…"), offered, parent);
}

}  // namespace nearfit::ui
