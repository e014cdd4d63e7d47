#include "ui/files/export/export_dialog.h"

#include <QComboBox>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QLabel>
#include <QLocale>
#include <QPushButton>
#include <QRadioButton>
#include <QSettings>
#include <QVBoxLayout>
#include <algorithm>
#include <array>
#include <utility>

#include "core/report/clearance_map.h"
#include "ui/widgets/font_scale.h"
#include "ui/widgets/format.h"
#include "ui/widgets/names.h"
#include "ui/widgets/preferences.h"

namespace nearfit::ui {
namespace {

const QString kKindKey = QStringLiteral("export/kind"), kUnitKey = QStringLiteral("export/metresPerUnit"),
              kSchemaKey = QStringLiteral("export/stepSchema");

struct ExportUnit {
  const char* name;
  const char* sign;
  double metres;
};
constexpr std::array<ExportUnit, 4> kUnits = {{{QT_TRANSLATE_NOOP("Unit", "Millimetres"), "mm", 1e-3},
                                               {QT_TRANSLATE_NOOP("Unit", "Centimetres"), "cm", 1e-2},
                                               {QT_TRANSLATE_NOOP("Unit", "Metres"), "m", 1.0},
                                               {QT_TRANSLATE_NOOP("Unit", "Inches"), "in", 0.0254}}};

QString sizeText(std::uint64_t bytes) {
  return QLocale().formattedDataSize(static_cast<qint64>(bytes), 1, QLocale::DataSizeSIFormat);
}

}  // namespace

ExportDialog::ExportDialog(Scene scene, std::vector<PartId> selected, QWidget* parent,
                           std::optional<ExportKind> kind)
    : QDialog(parent), scene_(std::move(scene)), selected_(std::move(selected)) {
  setObjectName(QStringLiteral("exportDialog"));
  setWindowTitle(tr("Export"));
  setUpFields();
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Save | QDialogButtonBox::Cancel, this);
  buttons->button(QDialogButtonBox::Save)->setText(tr("Export…"));
  connect(buttons, &QDialogButtonBox::accepted, this, [this] {
    remember();
    accept();
  });
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  layout()->addWidget(buttons);
  restore();
  if (kind) kind_->setCurrentIndex(kind_->findData(static_cast<int>(*kind)));
  for (QComboBox* box : {kind_, unit_})
    connect(box, QOverload<int>::of(&QComboBox::currentIndexChanged), this, &ExportDialog::showSummary);
  connect(chosen_, &QRadioButton::toggled, this, &ExportDialog::showSummary);
  showSummary();
}

void ExportDialog::setUpFields() {
  kind_ = new QComboBox(this);
  kind_->setObjectName(QStringLiteral("exportKind"));
  const auto add = [this](const QString& text, ExportKind kind) {
    kind_->addItem(text, static_cast<int>(kind));
  };
  add(tr("Placement and clearances (JSON)"), ExportKind::PlacementJson);
  add(tr("Placement table (CSV)"), ExportKind::PlacementCsv);
  add(tr("Merged mesh (binary STL)"), ExportKind::MeshStl);
  add(tr("Merged mesh (OBJ, with names)"), ExportKind::MeshObj);
  add(tr("Merged mesh (PLY, with colours)"), ExportKind::MeshPly);
  add(tr("Clearance map (PLY, with distances)"), ExportKind::ClearanceMapPly);
  add(tr("Clearance histogram (CSV)"), ExportKind::ClearanceHistogramCsv);
  add(tr("Assembly (glTF binary, GLB)"), ExportKind::AssemblyGlb);
  add(tr("Assembly (3MF)"), ExportKind::AssemblyThreeMf);
  add(tr("Assembly (URDF, fixed joints)"), ExportKind::AssemblyUrdf);
  add(tr("Assembly (STEP)"), ExportKind::AssemblyStep);
  visible_ = new QRadioButton(tr("All &visible"), this);
  chosen_ = new QRadioButton(tr("&Selected (%1)").arg(selected_.size()), this);
  visible_->setObjectName(QStringLiteral("exportVisible"));
  chosen_->setObjectName(QStringLiteral("exportSelected"));
  visible_->setChecked(true);
  unit_ = new QComboBox(this);
  unit_->setObjectName(QStringLiteral("exportUnit"));
  for (const ExportUnit& unit : kUnits)
    unit_->addItem(tr(unit.name), unit.metres);
  schema_ = new QComboBox(this);
  schema_->setObjectName(QStringLiteral("exportSchema"));
  schema_->setToolTip(tr("Schema of a STEP file: AP214 is read by all CAD systems, AP242 is its successor"));
  schema_->addItem(tr("AP214"), static_cast<int>(StepSchema::Ap214));
  schema_->addItem(tr("AP242"), static_cast<int>(StepSchema::Ap242));
  summary_ = new QLabel(this);
  summary_->setObjectName(QStringLiteral("exportSummary"));
  summary_->setWordWrap(true);
  summary_->setAlignment(Qt::AlignTop);
  summary_->setMinimumHeight(6 * summary_->fontMetrics().lineSpacing());
  auto* parts = new QHBoxLayout;
  parts->addWidget(visible_);
  parts->addWidget(chosen_);
  parts->addStretch();
  auto* form = new QFormLayout;
  form->addRow(tr("&Format"), kind_);
  partsLabel_ = new QLabel(tr("Parts"), this);
  form->addRow(partsLabel_, parts);
  unitLabel_ = new QLabel(tr("&Unit"), this);
  unitLabel_->setBuddy(unit_);
  form->addRow(unitLabel_, unit_);
  schemaLabel_ = new QLabel(tr("S&chema"), this);
  schemaLabel_->setBuddy(schema_);
  form->addRow(schemaLabel_, schema_);
  form->addRow(tr("What is written"), summary_);
  auto* column = new QVBoxLayout(this);
  column->addLayout(form);
  setMinimumWidth(forFont(*this, 480));
}

void ExportDialog::restore() {
  const QSettings settings;
  const int kind = kind_->findData(settings.value(kKindKey, 0).toInt());
  const int unit = unit_->findData(settings.value(kUnitKey, 1e-3).toDouble());
  const int schema = schema_->findData(settings.value(kSchemaKey, 0).toInt());
  kind_->setCurrentIndex(std::max(kind, 0));
  unit_->setCurrentIndex(std::max(unit, 0));
  schema_->setCurrentIndex(std::max(schema, 0));
}

void ExportDialog::remember() const {
  QSettings settings;
  settings.setValue(kKindKey, kind_->currentData());
  settings.setValue(kUnitKey, unit_->currentData());
  settings.setValue(kSchemaKey, schema_->currentData());
}

SceneExport ExportDialog::choice() const {
  SceneExport what;
  what.kind = static_cast<ExportKind>(kind_->currentData().toInt());
  what.metresPerUnit = unit_->currentData().toDouble();
  what.schema = static_cast<StepSchema>(schema_->currentData().toInt());
  if (chosen_->isChecked()) what.only = selected_;
  what.map = {mapSubject(scene_, selected_), Preferences::clearanceRange(), Preferences::hasNearClearances()};
  return what;
}

void ExportDialog::showSummary() {
  const ExportKind kind = choice().kind;
  const auto mesh = meshKindOf(kind);
  const bool hasParts = hasChosenParts(kind);
  const bool isMap = kind == ExportKind::ClearanceMapPly || kind == ExportKind::ClearanceHistogramCsv;
  for (QWidget* field : {static_cast<QWidget*>(unit_), static_cast<QWidget*>(unitLabel_)})
    field->setEnabled(hasUnitOfChoice(kind));
  for (QWidget* field : {static_cast<QWidget*>(schema_), static_cast<QWidget*>(schemaLabel_)})
    field->setEnabled(kind == ExportKind::AssemblyStep);
  for (QWidget* field : {static_cast<QWidget*>(partsLabel_), static_cast<QWidget*>(visible_)})
    field->setEnabled(hasParts);
  chosen_->setEnabled(hasParts && !selected_.empty());
  summary_->setText(mesh               ? meshSummary(*mesh)
                    : isAssembly(kind) ? assemblySummary(kind)
                    : isMap            ? mapSummary()
                                       : placementSummary());
  const bool hasContent =
      isMap ? !choice().map.subject.empty() : !hasParts || !chosenParts(scene_, choice().only).empty();
  findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Save)->setEnabled(hasContent);
}

QString ExportDialog::meshSummary(MeshFileKind kind) const {
  const auto parts = chosenParts(scene_, choice().only);
  if (parts.empty()) return tr("Nothing: no part is visible.");
  const MeshExportSize size = meshExportSize(parts, kind);
  const QLocale locale;
  const QString unit = QLatin1String(kUnits[static_cast<std::size_t>(unit_->currentIndex())].sign);
  const QString text =
      tr("%1 as one mesh in the world frame, in %2: %3 triangles, about %4.")
          .arg(formatParts(size.parts), unit, locale.toString(static_cast<qulonglong>(size.triangles)),
               sizeText(size.bytes));
  switch (kind) {
    case MeshFileKind::StlBinary:
      return text + QChar(' ') + tr("Single precision (seven figures); no names.");
    case MeshFileKind::Obj:
      return text + QChar(' ') + tr("Double precision; each part is an object and a group of its name.");
    case MeshFileKind::Ply:
      break;
  }
  return text + QChar(' ') + tr("Double precision; each part in its colour.");
}

QString ExportDialog::assemblySummary(ExportKind kind) const {
  const auto parts = chosenParts(scene_, choice().only);
  if (parts.empty()) return tr("Nothing: no part is visible.");
  const QString text =
      tr("%1 with their groups, names, colours and poses. Parts with the same mesh share it.")
          .arg(formatParts(parts.size())) +
      QChar(' ');
  switch (kind) {
    case ExportKind::AssemblyStep:
      return text + tr("In mm. Parts of STEP, IGES and BREP files have their exact surfaces, if their file "
                       "is unchanged "
                       "and their mesh not repaired; others are planar facets.");
    case ExportKind::AssemblyGlb:
      return text + tr("In metres, y up as the format demands; one file, vertices in single precision.");
    case ExportKind::AssemblyThreeMf:
      return text + tr("In %1; parts of one mesh in several colours have copies of it.")
                        .arg(QLatin1String(kUnits[static_cast<std::size_t>(unit_->currentIndex())].sign));
    default:
      return text +
             tr("In metres; each part is a link on a fixed joint. Meshes are STL files in a folder beside "
                "the file. Mass and inertia where a density is set and the mesh has a volume.");
  }
}

QString ExportDialog::mapSummary() const {
  const std::vector<PartId> subject = choice().map.subject;
  if (subject.empty()) return tr("Nothing: select the part to map, or take one in hand.");
  const bool isGroup = subject.size() > 1 && scene_.movingGroup();
  const QString name = breakable(
      shortName(isGroup ? scene_.findGroup(*scene_.movingGroup())->name : scene_.get(subject.front()).name));
  const double range = Preferences::clearanceRange();
  const QString within = range > 0.0 ? formatLength(range) : tr("an automatic range");
  if (choice().kind == ExportKind::ClearanceHistogramCsv)
    return tr("The surface area of %1 by its distance to other visible parts, within %2: from, to [m], area "
              "[m^2] and share of the surface.")
        .arg(name, within);
  const QString unit = QLatin1String(kUnits[static_cast<std::size_t>(unit_->currentIndex())].sign);
  const QString others =
      Preferences::hasNearClearances() ? tr(" Near parts too, with their distance to it.") : QString();
  return tr("The surface of %1 within %3 of other visible parts, in the world frame, with colours and, "
            "at each vertex, the distance to the nearest one; coordinates and distances in %2. The rest of "
            "the surface is left out.")
             .arg(name, unit, within) +
         others;
}

QString ExportDialog::placementSummary() const {
  const QString parts = formatParts(scene_.parts().size());
  if (choice().kind == ExportKind::PlacementCsv)
    return tr("A table of %1: name, mesh file and SHA-256, position [m], quaternion (w x y z) and the 4x4 "
              "matrix "
              "by rows, all in the world frame.")
        .arg(parts);
  const Part* moving = scene_.movingPart() ? scene_.find(*scene_.movingPart()) : nullptr;
  const QString poses = tr("The placement of %1: name, mesh file and SHA-256, position [m], quaternion and "
                           "4x4 matrix in the world frame.")
                            .arg(parts);
  if (moving == nullptr) return poses + QChar(' ') + tr("No clearances, because no part is in hand.");
  return poses + QChar(' ') +
         tr("Also every local minimum distance within the cutoff between %1 and each other visible part.")
             .arg(breakable(shortName(scene_.movingGroup() ? scene_.findGroup(*scene_.movingGroup())->name
                                                           : moving->name)));
}

}  // namespace nearfit::ui
