#include "ui/files/refine_dialog.h"

#include <QCheckBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLocale>
#include <QPushButton>
#include <QStringList>
#include <QVBoxLayout>
#include <algorithm>
#include <cstddef>
#include <numbers>
#include <set>

#include "core/scene/document_load.h"
#include "ui/widgets/font_scale.h"
#include "ui/widgets/names.h"
#include "ui/widgets/number_field.h"

namespace nearfit::ui {
namespace {

/// Factor of the buttons *Finer* and *Coarser* on the chord, and with its root on the angle: a chord is as the square
/// of the angle, so that both tolerances keep their part.
constexpr double kChordStep = 2.0, kAngleStep = std::numbers::sqrt2;
/// Shown where the importer does not say what is in effect: a tenth of a millimetre, and twenty degrees [m, rad].
constexpr Tessellation kUnknown{1e-4, 0.35};

/// What is known of the shapes before they are refined.
struct Present {
  Tessellation asked;      ///< Of the first shape.
  Tessellation effective;  ///< The finest.
  std::size_t shapes = 0, triangles = 0, parts = 0;
  QStringList names;
};

Present presentOf(const Scene& scene, const Refinement& refinement) {
  Present present;
  std::set<const PartGeometry*> seen;
  for (const Refinement::Member& member : refinement.members) {
    const Part& part = scene.get(member.part);
    present.names << QString::fromStdString(part.name);
    ++present.parts;
    if (!seen.insert(part.geometry.get()).second) continue;
    const auto finer = [](double a, double b) {
      return a == 0.0 || b == 0.0 ? std::max(a, b) : std::min(a, b);
    };
    if (present.shapes == 0) present.asked = part.geometry->tessellation;
    present.effective.chord = finer(present.effective.chord, part.geometry->effectiveTessellation.chord);
    present.effective.angle = finer(present.effective.angle, part.geometry->effectiveTessellation.angle);
    present.triangles += part.geometry->mesh.triangles().size();
    ++present.shapes;
  }
  return present;
}

QString textOf(const Present& present) {
  constexpr int kNamed = 3;
  const QString triangles = QLocale().toString(static_cast<qulonglong>(present.triangles));
  if (present.parts == 1)
    return QObject::tr("“%1” has %2 triangles. How many it will have is known once it is read again.")
        .arg(shortName(present.names.first()), triangles);
  return QObject::tr(
             "%1 share %2 triangles and change together. How many they will have is known once they are read "
             "again.")
      .arg(listOfNames(present.names, kNamed), triangles);
}

/// What a dialog is for.
struct TessellationWords {
  QString name;  ///< Of the object.
  QString title, text, automaticHelp, accept;
};

/// Chord and angle, or those that suit the size.
class TessellationDialog : public QDialog {
 public:
  /// @param asked, effective  As in Present.
  TessellationDialog(const TessellationWords& words, const Tessellation& asked, const Tessellation& effective,
                     QWidget* parent);
  Tessellation tessellation() const;

 private:
  void scale(double chordFactor, double angleFactor);

  QCheckBox* automatic_;
  NumberField *chord_, *angle_;
  /// The values at first, and the same as the fields round them.
  Tessellation present_, rounded_;
};

TessellationDialog::TessellationDialog(const TessellationWords& words, const Tessellation& asked,
                                       const Tessellation& effective, QWidget* parent)
    : QDialog(parent),
      automatic_(new QCheckBox(QObject::tr("&Suited to the size of each shape"), this)),
      chord_(new NumberField(this)),
      angle_(new NumberField(this)) {
  setObjectName(words.name);
  setWindowTitle(words.title);
  auto* text = new QLabel(breakable(words.text), this);
  text->setObjectName(QStringLiteral("refineText"));
  text->setTextFormat(Qt::PlainText);
  text->setWordWrap(true);
  automatic_->setObjectName(QStringLiteral("refineAutomatic"));
  automatic_->setToolTip(words.automaticHelp);
  chord_->setObjectName(QStringLiteral("refineChord"));
  chord_->setLength(4);
  chord_->setTrimmed(true);
  chord_->setQuantityRange(kMinChord, kMaxChord);
  chord_->setQuantityStep(1e-5);
  chord_->setHelp(QObject::tr("Max distance between an exact surface and its triangles. Smaller is finer"));
  angle_->setObjectName(QStringLiteral("refineAngle"));
  angle_->setUnit(QStringLiteral("°"));
  angle_->setDecimals(1);
  angle_->setQuantityRange(kMinFacetAngle, kMaxFacetAngle);
  angle_->setQuantityStep(0.0175);
  angle_->setHelp(QObject::tr("Max angle between neighbouring facets of a surface. Smaller is finer"));
  chord_->showQuantity(effective.chord > 0.0 ? effective.chord : kUnknown.chord);
  angle_->showQuantity(effective.angle > 0.0 ? effective.angle : kUnknown.angle);
  present_ = asked == Tessellation{} ? effective : asked;
  rounded_ = {chord_->quantity(), angle_->quantity()};
  const auto setAutomatic = [this](bool isOn) {
    chord_->setEnabled(!isOn);
    angle_->setEnabled(!isOn);
  };
  connect(automatic_, &QCheckBox::toggled, this, setAutomatic);
  auto* finer = new QPushButton(QObject::tr("&Finer"), this);
  auto* coarser = new QPushButton(QObject::tr("&Coarser"), this);
  finer->setObjectName(QStringLiteral("refineFiner"));
  coarser->setObjectName(QStringLiteral("refineCoarser"));
  finer->setToolTip(
      QObject::tr("Half the chord and 0.7 times the angle: about 1.4 times the facets round a cylinder"));
  coarser->setToolTip(
      QObject::tr("Twice the chord and 1.4 times the angle: about 0.7 times the facets round a cylinder"));
  finer->setAutoDefault(false);
  coarser->setAutoDefault(false);
  connect(finer, &QPushButton::clicked, this, [this] { scale(1.0 / kChordStep, 1.0 / kAngleStep); });
  connect(coarser, &QPushButton::clicked, this, [this] { scale(kChordStep, kAngleStep); });
  auto* steps = new QHBoxLayout;
  steps->addWidget(finer);
  steps->addWidget(coarser);
  steps->addStretch();
  auto* form = new QFormLayout;
  form->addRow(QObject::tr("C&hord"), chord_);
  form->addRow(QObject::tr("&Angle"), angle_);
  form->addRow(QString(), steps);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
  buttons->button(QDialogButtonBox::Ok)->setText(words.accept);
  connect(buttons, &QDialogButtonBox::accepted, this, [this] {
    chord_->settle();
    angle_->settle();
    // What cannot be read stays to be corrected.
    if (automatic_->isChecked() || (!chord_->isFaulty() && !angle_->isFaulty())) accept();
  });
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(text);
  layout->addWidget(automatic_);
  layout->addLayout(form);
  layout->addWidget(buttons);
  setMinimumWidth(forFont(*this, 380));
  automatic_->setChecked(asked == Tessellation{});
  setAutomatic(automatic_->isChecked());
}

void TessellationDialog::scale(double chordFactor, double angleFactor) {
  automatic_->setChecked(false);
  chord_->showQuantity(std::clamp(chord_->quantity() * chordFactor, kMinChord, kMaxChord));
  angle_->showQuantity(std::clamp(angle_->quantity() * angleFactor, kMinFacetAngle, kMaxFacetAngle));
}

Tessellation TessellationDialog::tessellation() const {
  if (automatic_->isChecked()) return {};
  // What was not touched has not changed by a rounding.
  Tessellation wanted{chord_->quantity(), angle_->quantity()};
  if (wanted.chord == rounded_.chord && present_.chord > 0.0) wanted.chord = present_.chord;
  if (wanted.angle == rounded_.angle && present_.angle > 0.0) wanted.angle = present_.angle;
  return wanted;
}

}  // namespace

std::optional<Tessellation> askForTessellation(const Scene& scene, const Refinement& refinement,
                                               QWidget* parent) {
  const Present present = presentOf(scene, refinement);
  const TessellationWords words{
      QStringLiteral("refineDialog"), QObject::tr("Refine"), textOf(present),
      QObject::tr("Let the importer choose both from the size, as when the file was opened"),
      QObject::tr("Refine")};
  TessellationDialog dialog(words, present.asked, present.effective, parent);
  return dialog.exec() == QDialog::Accepted ? std::optional(dialog.tessellation()) : std::nullopt;
}

std::optional<Tessellation> askForImportTessellation(const Tessellation& present, QWidget* parent) {
  const TessellationWords words{
      QStringLiteral("importTessellationDialog"), QObject::tr("Triangles of CAD files"),
      QObject::tr("Triangles of exact surfaces in CAD files that you open or add from now on. Those in the "
                  "scene stay as they are: “Refine…” changes them."),
      QObject::tr("Let the importer choose both from the size"), QObject::tr("Use")};
  TessellationDialog dialog(words, present, present, parent);
  return dialog.exec() == QDialog::Accepted ? std::optional(dialog.tessellation()) : std::nullopt;
}

}  // namespace nearfit::ui
