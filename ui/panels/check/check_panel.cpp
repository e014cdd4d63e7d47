#include "ui/panels/check/check_panel.h"

#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLocale>
#include <QPushButton>
#include <QSortFilterProxyModel>
#include <QTableView>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "ui/model/findings_model.h"
#include "ui/model/hand_state.h"
#include "ui/model/part_checks.h"
#include "ui/model/scene_work.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/panels/check/repair_fields.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/font_scale.h"
#include "ui/widgets/format.h"
#include "ui/widgets/names.h"
#include "ui/widgets/row_table.h"

namespace nearfit::ui {
namespace {

/// Min size of what the camera goes to, as a fraction of the part's diagonal: a crack alone would fill the view without
/// saying where it is.
constexpr double kLeastSeen = 0.15;

/// The box of a finding in the world, with room around it.
Aabb seenBox(const MeshFinding& finding, const TriangleMesh& mesh, const RigidTransform& worldFromPart) {
  const double room = 0.5 * kLeastSeen * mesh.bounds().diagonal();
  const glm::dvec3 lower = finding.box.lower - room, upper = finding.box.upper + room;
  Aabb box;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p((corner & 1) != 0 ? upper.x : lower.x, (corner & 2) != 0 ? upper.y : lower.y,
                       (corner & 4) != 0 ? upper.z : lower.z);
    box.add(worldFromPart.applyToPoint(p));
  }
  return box;
}

/// As high as it must be: it has the rest of a large panel, and a small panel scrolls no further than needed. Counts and
/// places, whose tool tips have all of them, are as wide as the effect, which matters most, leaves them room.
class FindingsTable : public QTableView {
 public:
  using QTableView::QTableView;
  QSize sizeHint() const override { return minimumSize(); }
  void setModel(QAbstractItemModel* model) override {
    QTableView::setModel(model);
    connect(model, &QAbstractItemModel::modelReset, this, [this] { fitColumns(); });
    connect(model, &QAbstractItemModel::dataChanged, this, [this] { fitColumns(); });
  }

 protected:
  void resizeEvent(QResizeEvent* event) override {
    QTableView::resizeEvent(event);
    fitColumns();
  }

 private:
  void fitColumns() {
    const auto needed = [this](int column) {
      return std::max(sizeHintForColumn(column), horizontalHeader()->sectionSizeHint(column));
    };
    const int room = viewport()->width() - needed(FindingsModel::Kind) - needed(FindingsModel::Size) -
                     needed(FindingsModel::Effect);
    const int leastCount = forFont(*this, 60), leastPlace = forFont(*this, 72);
    const int count = std::max(leastCount, std::min(needed(FindingsModel::Count), room - leastPlace));
    horizontalHeader()->resizeSection(FindingsModel::Count, count);
    horizontalHeader()->resizeSection(
        FindingsModel::Place, std::max(leastPlace, std::min(needed(FindingsModel::Place), room - count)));
  }
};

QString stepText(const RepairStep& step) {
  const auto number = [](std::uint64_t count) { return QLocale().toString(static_cast<qulonglong>(count)); };
  switch (step.repair.kind) {
    case RepairKind::Weld:
      return CheckPanel::tr("vertices welded: %1").arg(number(step.changed));
    case RepairKind::Stitch:
      return CheckPanel::tr("border vertices joined: %1, faces split: %2")
          .arg(number(step.changed), number(step.addedFaces));
    case RepairKind::Clean:
      if (step.wallFaces > 0)
        return CheckPanel::tr("faces removed: %1, of them walls inside: %2, swapped: %3")
            .arg(number(step.removedFaces), number(step.wallFaces), number(step.changed));
      return CheckPanel::tr("faces removed: %1, swapped: %2")
          .arg(number(step.removedFaces), number(step.changed));
    case RepairKind::Orient:
      return CheckPanel::tr("faces turned: %1").arg(number(step.changed));
    case RepairKind::FillHoles:
      return step.left > 0 ? CheckPanel::tr("holes filled: %1 with %2 faces, left open: %3")
                                 .arg(number(step.changed), number(step.addedFaces), number(step.left))
                           : CheckPanel::tr("holes filled: %1 with %2 faces")
                                 .arg(number(step.changed), number(step.addedFaces));
    case RepairKind::DropShells:
      break;
  }
  return CheckPanel::tr("pieces removed: %1 of %2 faces")
      .arg(number(step.changed), number(step.removedFaces));
}

/// "+1.2 %", by which something changed.
QString shareText(double before, double after) {
  if (!(before != 0.0)) return QStringLiteral("–");
  const double percent = 100.0 * (after - before) / std::abs(before);
  return (percent > 0.0 ? QStringLiteral("+") : QString()) + QLocale().toString(percent, 'g', 3) +
         QStringLiteral(" %");
}

/// Says where the surface moved the most, if nothing came in the place of what was there.
QString placeText(const GeometryRepair& repair) {
  const auto has = [&repair](auto isIn) { return std::ranges::any_of(repair.steps, isIn); };
  const bool isRemoval = repair.change.isOfRemoved && has([](const RepairStep& step) {
                           const bool canRemove = step.repair.kind == RepairKind::Clean ||
                                                  step.repair.kind == RepairKind::DropShells;
                           return canRemove && step.removedFaces > 0;
                         });
  if (!isRemoval) return {};
  const bool isOfWalls =
      has([](const RepairStep& step) { return step.wallFaces > 0; }) && !has([](const RepairStep& step) {
        return step.repair.kind == RepairKind::DropShells && step.removedFaces > 0;
      });
  return isOfWalls ? CheckPanel::tr(", where walls were removed")
                   : CheckPanel::tr(", where faces were removed");
}

QString repairText(const GeometryRepair& repair) {
  QStringList steps;
  for (const RepairStep& step : repair.steps) {
    if (!step.isNothing() || step.left > 0) steps << stepText(step);
  }
  if (!repair.geometry) return CheckPanel::tr("There was nothing to repair in this way.");
  const MeshChange& change = repair.change;
  const QString moved = formatLength(change.maxDistance) + placeText(repair);
  QString text =
      CheckPanel::tr("Repaired: %1. The surface moved by at most %2; area %3")
          .arg(steps.join(QStringLiteral("; ")), moved, shareText(change.before.area, change.after.area));
  if (change.before.volume && change.after.volume)
    text += CheckPanel::tr(", volume %1").arg(shareText(*change.before.volume, *change.after.volume));
  else if (change.after.volume)
    text += CheckPanel::tr(", and it encloses a volume now");
  return text + '.';
}

}  // namespace

CheckPanel::CheckPanel(const Context& context, QWidget* parent)
    : QWidget(parent),
      context_(context),
      marks_(context.view.overlay()),
      model_(new FindingsModel(this)),
      sorted_(new QSortFilterProxyModel(this)),
      table_(new FindingsTable(this)),
      title_(new QLabel(this)),
      note_(new QLabel(this)),
      unrepaired_(new QLabel(this)),
      result_(new QLabel(this)),
      fields_(new RepairFields(this)),
      repair_(new QPushButton(tr("Re&pair"), this)) {
  setUpTable();
  setUpLayout();
  connect(repair_, &QPushButton::clicked, this, &CheckPanel::repair);
  connect(fields_, &RepairFields::changed, this, &CheckPanel::showState);
  connect(&context.selection, &Selection::changed, this, &CheckPanel::follow);
  connect(&context.checks, &PartChecks::changed, this, &CheckPanel::follow);
  connect(&context.work, &SceneWork::busyChanged, this, &CheckPanel::showState);
  connect(&context.hand, &HandState::changed, this, &CheckPanel::showState);
  connect(&context.view.poses(), &ShownPoses::changed, this, &CheckPanel::placeMarks);
  changes_ = context.session.onChange(SceneEvents::Stage::Panels, [this] { follow(); });
  follow();
}

void CheckPanel::setUpTable() {
  sorted_->setSourceModel(model_);
  sorted_->setSortRole(FindingsModel::kSortRole);
  table_->setObjectName(QStringLiteral("findingsTable"));
  table_->setAccessibleName(tr("Findings"));
  table_->setModel(sorted_);
  setUpRowTable(*table_);
  table_->sortByColumn(FindingsModel::Effect, Qt::DescendingOrder);
  // The panel scrolls where it is narrower.
  table_->setMinimumSize(forFont(*table_, 480), forFont(*table_, 90));
  QHeaderView* header = table_->horizontalHeader();
  header->setSectionResizeMode(FindingsModel::Kind, QHeaderView::ResizeToContents);
  header->setSectionResizeMode(FindingsModel::Size, QHeaderView::ResizeToContents);
  header->setSectionResizeMode(FindingsModel::Effect, QHeaderView::Stretch);
  header->setHighlightSections(false);
  connect(table_->selectionModel(), &QItemSelectionModel::selectionChanged, this,
          [this] { showPlace(true); });
}

void CheckPanel::setUpLayout() {
  title_->setObjectName(QStringLiteral("checkTitle"));
  note_->setObjectName(QStringLiteral("checkNote"));
  unrepaired_->setObjectName(QStringLiteral("checkUnrepaired"));
  result_->setObjectName(QStringLiteral("repairResult"));
  for (QLabel* label : {title_, note_, unrepaired_, result_}) {
    label->setWordWrap(true);
    label->setTextFormat(Qt::PlainText);
  }
  // Else the view would change its size with each row that is chosen.
  note_->setMinimumHeight(note_->fontMetrics().lineSpacing());
  result_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  result_->hide();
  unrepaired_->hide();
  repair_->setObjectName(QStringLiteral("repairPart"));
  repair_->setToolTip(
      tr("Repair the part's mesh in this scene, as one step to undo; its file stays as it is"));
  auto* findings = new QVBoxLayout;
  findings->addWidget(title_);
  findings->addWidget(table_, 1);
  findings->addWidget(note_);
  findings->addWidget(unrepaired_);
  findings->addWidget(result_);
  auto* repairs = new QVBoxLayout;
  repairs->addWidget(fields_, 1);
  repairs->addWidget(repair_);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(8, 6, 8, 6);
  row->setSpacing(10);
  row->addLayout(findings, 1);
  row->addLayout(repairs);
}

const Part* CheckPanel::subject() const {
  const std::optional<PartId> current = context_.selection.current();
  const Part* part = current ? context_.session.scene().find(*current) : nullptr;
  return part != nullptr && part->geometry != nullptr ? part : nullptr;
}

void CheckPanel::follow() {
  const Part* part = subject();
  const PartGeometryPtr geometry = part != nullptr ? part->geometry : nullptr;
  const std::shared_ptr<const MeshCheck> check = context_.checks.of(geometry);
  const bool isNewPart = geometry != geometry_;
  const bool isNew = isNewPart || check != check_;
  geometry_ = geometry;
  check_ = check;
  if (isNewPart && isVisible() && geometry_) context_.checks.prefer(geometry_);
  if (isNew) {
    model_->show(check_);
    const std::vector<UnrepairedKind> unrepaired =
        check_ ? unrepairedKinds(*check_, geometry_->repairs) : std::vector<UnrepairedKind>{};
    if (check_) fields_->suggest(*check_, unrepaired, geometry_->mesh.bounds().diagonal());
    showUnrepaired(unrepaired);
    showPlace(false);
  }
  if (geometry_ != repaired_.lock()) result_->hide();
  placeMarks();
  showState();
}

QString CheckPanel::noteText() const {
  if (!geometry_) return {};
  if (context_.checks.hasFailed(geometry_))
    return tr("The part could not be checked: there was not enough memory.");
  if (!check_) {
    if (context_.hand.status().isTaken()) return tr("It is checked once no part is felt.");
    return tr("It is being checked…");
  }
  QStringList cut;
  for (std::size_t i = 0; i < kFindingKinds; ++i) {
    const FindingTotal& total = check_->totals[i];
    const QString kind = nameOf(static_cast<FindingKind>(i));
    if (total.isCut) cut << tr("%1: there may be more, the search ended at a limit.").arg(kind);
    if (total.places > MeshCheck::kMaxPlaces)
      cut << tr("%1: %L2 of %L3 places are listed.").arg(kind).arg(MeshCheck::kMaxPlaces).arg(total.places);
  }
  if (!cut.isEmpty()) return cut.join(' ');
  if (check_->findings.empty()) return tr("Nothing is wrong with its mesh.");
  if (!table_->selectionModel()->hasSelection()) return tr("Select a row to see where it is.");
  return {};
}

void CheckPanel::showUnrepaired(const std::vector<UnrepairedKind>& kinds) {
  QStringList lines;
  for (const UnrepairedKind& left : kinds) {
    const QString text =
        left.areAll ? tr("%1 cannot be repaired: %2.") : tr("%1 cannot all be repaired: %2.");
    lines << text.arg(nameOf(left.kind), QString::fromStdString(left.reason));
  }
  unrepaired_->setText(lines.join('\n'));
  unrepaired_->setVisible(!lines.isEmpty());
}

void CheckPanel::showState() {
  const Part* part = subject();
  title_->setText(part != nullptr ? tr("Mesh of %1").arg(shortName(part->name))
                                  : tr("Select a part to see what is wrong with its mesh."));
  note_->setText(noteText());
  const bool isLocked = part != nullptr && context_.session.scene().isLocked(*part);
  const bool isAnyChosen = fields_->isAnyChosen();
  fields_->setEnabled(part != nullptr);
  repair_->setEnabled(part != nullptr && !isLocked && isAnyChosen && !context_.work.isBusy() &&
                      !context_.hand.status().isTaken());
}

void CheckPanel::showPlace(bool isNew) {
  const Part* part = subject();
  const QModelIndexList rows = table_->selectionModel()->selectedRows();
  const bool hasRow = part != nullptr && !rows.isEmpty() && isVisible() && check_ != nullptr;
  const bool wasShown = marks_.isShown();
  if (hasRow) {
    const MeshFinding& finding = model_->at(sorted_->mapToSource(rows.first()).row());
    const RigidTransform pose = context_.view.poses().shownPoseOf(*part);
    marks_.show(finding, pose);
    if (isNew && finding.hasPlace) context_.view.fitBox(seenBox(finding, part->geometry->mesh, pose));
  } else {
    marks_.clear();
  }
  note_->setText(noteText());
  if (hasRow || wasShown) context_.view.requestRender();
}

void CheckPanel::placeMarks() {
  const Part* part = subject();
  if (part == nullptr || !marks_.isShown()) return;
  marks_.setPose(context_.view.poses().shownPoseOf(*part));
  context_.view.requestRender();
}

void CheckPanel::refresh() {
  model_->refresh();
}

std::vector<PartId> CheckPanel::partsToRepair() const {
  std::vector<PartId> parts;
  for (const PartId id : context_.selection.parts()) {
    const Part* part = context_.session.scene().find(id);
    if (part != nullptr && part->geometry == geometry_) parts.push_back(id);
  }
  return parts;
}

void CheckPanel::repair() {
  const MeshRepairs repairs = fields_->repairs();
  if (geometry_ && !repairs.empty()) emit repairRequested(partsToRepair(), repairs);
}

void CheckPanel::showRepair(const GeometryRepair& repair) {
  repaired_ = repair.geometry ? repair.geometry : geometry_;
  result_->setText(repairText(repair));
  result_->show();
}

void CheckPanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  if (geometry_) context_.checks.prefer(geometry_);
  showPlace(false);
}

void CheckPanel::hideEvent(QHideEvent* event) {
  QWidget::hideEvent(event);
  // Nothing else: the window hides its panels while it goes, when the model is gone.
  if (!marks_.isShown()) return;
  marks_.clear();
  context_.view.requestRender();
}

}  // namespace nearfit::ui
