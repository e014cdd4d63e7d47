#include "ui/panels/check/repair_fields.h"

#include <QCheckBox>
#include <QGridLayout>
#include <algorithm>
#include <initializer_list>

#include "ui/widgets/number_field.h"

namespace nearfit::ui {
namespace {

/// Sizes offered, as fractions of a part's diagonal: welding below all that is meant, components that are crumbs, small
/// holes.
constexpr double kWeldShare = 1e-6, kDropShare = 0.01, kFillShare = 0.05;
/// A border with a larger share of the diagonal is rather the outline of a sheet than a hole.
constexpr double kMaxHoleShare = 0.85;
/// Room above a size that is found, for its rounding to two figures.
constexpr double kRoom = 1.05;
constexpr int kRepairDecimals = 7;

/// True if findings of the kind are there that loading has not mended and a repair may mend.
bool canMend(const MeshCheck& check, const std::vector<UnrepairedKind>& unrepaired, FindingKind kind) {
  const auto isLeft = [kind](const UnrepairedKind& left) { return left.kind == kind && left.areAll; };
  return std::ranges::any_of(
             check.findings,
             [kind](const MeshFinding& finding) { return finding.kind == kind && !finding.isMended; }) &&
         std::ranges::none_of(unrepaired, isLeft);
}

/// Two figures are enough for what is a choice anyway.
double rounded(double length) {
  return length > 0.0 ? QString::number(length, 'g', 2).toDouble() : 0.0;
}

/// Large enough for all that looks like a hole [m].
double fillSizeFor(const MeshCheck& check, double diagonal) {
  double largest = 0.0;
  for (const MeshFinding& finding : check.findings) {
    if (finding.kind != FindingKind::OpenEdges) continue;
    const double size = finding.box.diagonal();
    if (size <= kMaxHoleShare * diagonal) largest = std::max(largest, size);
  }
  return largest > 0.0 ? kRoom * largest : kFillShare * diagonal;
}

}  // namespace

RepairFields::RepairFields(QWidget* parent) : QWidget(parent) {
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setVerticalSpacing(2);
  weld_ = addRow(*grid, "Weld", tr("&Weld vertices within"), tr("Merge vertices that are nearer than this"),
                 tr("Vertices nearer than this become one"));
  clean_ = addRow(*grid, "Clean", tr("&Remove faulty faces"),
                  tr("Remove faces without area, and faces that repeat others"), {});
  stitch_ = addRow(*grid, "Stitch", tr("&Stitch borders within"),
                   tr("Close cracks: join open borders that are nearer than this"),
                   tr("Borders nearer than this are joined"));
  drop_ = addRow(*grid, "Drop", tr("&Drop pieces up to"),
                 tr("Remove components whose bounding box has a diagonal of at most this"),
                 tr("Diagonal of the largest piece to remove"));
  orient_ = addRow(*grid, "Orient", tr("&Orient faces"),
                   tr("Make neighbours agree on the outside, and turn closed shells outside out"), {});
  fill_ = addRow(*grid, "Fill", tr("&Fill holes up to"),
                 tr("Fill holes whose bounding box has a diagonal of at most this"),
                 tr("Diagonal of the largest hole to fill"));
  grid->setRowStretch(grid->rowCount(), 1);
}

RepairFields::Row RepairFields::addRow(QGridLayout& grid, const char* name, const QString& text,
                                       const QString& help, const QString& sizeHelp) {
  const int line = grid.rowCount();
  Row row;
  row.check = new QCheckBox(text, this);
  row.check->setObjectName(QStringLiteral("repair") + QLatin1String(name));
  row.check->setToolTip(help);
  grid.addWidget(row.check, line, 0);
  connect(row.check, &QCheckBox::toggled, this, &RepairFields::changed);
  if (sizeHelp.isEmpty()) return row;
  row.size = new NumberField(this);
  row.size->setObjectName(QStringLiteral("repair%1Size").arg(QLatin1String(name)));
  row.size->setAccessibleName(QString(text).remove('&'));
  row.size->setTrimmed(true);
  row.size->setLength(kRepairDecimals);
  row.size->setQuantityRange(kMinRepairSize, kMaxRepairSize);
  row.size->setHelp(sizeHelp);
  row.size->setEnabled(false);
  grid.addWidget(row.size, line, 1);
  connect(row.check, &QCheckBox::toggled, row.size, &QWidget::setEnabled);
  return row;
}

void RepairFields::offer(const Row& row, bool isOn, double size) {
  row.check->setChecked(isOn);
  if (row.size == nullptr) return;
  row.size->setQuantityStep(size);
  row.size->showQuantity(rounded(size));
}

void RepairFields::suggest(const MeshCheck& check, const std::vector<UnrepairedKind>& unrepaired,
                           double diagonal) {
  const auto canMendAny = [&](std::initializer_list<FindingKind> kinds) {
    return std::ranges::any_of(kinds, [&](FindingKind kind) { return canMend(check, unrepaired, kind); });
  };
  offer(weld_, false, kWeldShare * diagonal);
  offer(stitch_, canMendAny({FindingKind::HairlineCracks}), check.crackTolerance);
  offer(clean_, canMendAny({FindingKind::DegenerateFaces, FindingKind::DuplicateFaces}), 0.0);
  offer(drop_, false, kDropShare * diagonal);
  offer(orient_, canMendAny({FindingKind::InvertedShells, FindingKind::InconsistentEdges}), 0.0);
  // Stitching comes first: what it closes is no hole.
  offer(fill_, canMendAny({FindingKind::OpenEdges}) && !canMendAny({FindingKind::HairlineCracks}),
        fillSizeFor(check, diagonal));
}

std::optional<double> RepairFields::sizeOf(const Row& row) {
  if (!row.check->isChecked()) return std::nullopt;
  row.size->settle();
  return row.size->quantity();
}

bool RepairFields::isAnyChosen() const {
  const auto isChosen = [](const Row* row) { return row->check->isChecked(); };
  return std::ranges::any_of(
      std::initializer_list<const Row*>{&weld_, &stitch_, &clean_, &drop_, &orient_, &fill_}, isChosen);
}

MeshRepairs RepairFields::repairs() {
  RepairChoice choice;
  choice.weld = sizeOf(weld_);
  choice.stitch = sizeOf(stitch_);
  choice.clean = clean_.check->isChecked();
  choice.drop = sizeOf(drop_);
  choice.orient = orient_.check->isChecked();
  choice.fill = sizeOf(fill_);
  return repairsOf(choice);
}

}  // namespace nearfit::ui
