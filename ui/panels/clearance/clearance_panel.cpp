#include "ui/panels/clearance/clearance_panel.h"

#include <QComboBox>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QPushButton>
#include <QSettings>
#include <QSignalBlocker>
#include <QSortFilterProxyModel>
#include <QTableView>
#include <QVBoxLayout>
#include <utility>

#include "core/files/atomic_write.h"
#include "ui/model/clearance_model.h"
#include "ui/model/hand_state.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/view3d/spot_label.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/font_scale.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/row_table.h"
#include "ui/widgets/save_file.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

const QString kThresholdKey = QStringLiteral("clearance/thresholdMillimetres");
constexpr double kMillimetre = 1e-3;
constexpr double kUsualThreshold = 1e-3, kThresholdStep = 1e-4, kMaxThreshold = 1e3;  ///< [m]
constexpr int kThresholdDecimals = 4;

/// Returns the threshold from the settings [m]; the usual one if somebody edited it to nonsense.
double keptThreshold() {
  bool isNumber = false;
  const double kept = kMillimetre * QSettings().value(kThresholdKey).toDouble(&isNumber);
  return isNumber && kept >= 0.0 && kept <= kMaxThreshold ? kept : kUsualThreshold;
}

}  // namespace

ClearancePanel::ClearancePanel(const Context& context, ClearanceSearch::PoseOfMoving poseOfMoving,
                               QWidget* window)
    : QWidget(window),
      session_(context.session),
      view_(context.view),
      search_(context.session, std::move(poseOfMoving)),
      segment_(context.view.overlay(), colours::kAccent),
      label_(new SpotLabel(context.view, QStringLiteral("clearanceLabel"))),
      model_(new ClearanceModel(this)) {
  setUpFields();
  setUpTable();
  note_ = new QLabel(this);
  note_->setObjectName(QStringLiteral("clearanceNote"));
  note_->setWordWrap(true);
  export_ = new QPushButton(icon(QStringLiteral("export")), tr("Export table…"), this);
  export_->setObjectName(QStringLiteral("exportClearances"));
  connect(export_, &QPushButton::clicked, this, &ClearancePanel::exportTable);
  auto* partLabel = new QLabel(tr("&Part"), this);
  auto* thresholdLabel = new QLabel(tr("&Threshold"), this);
  partLabel->setBuddy(subject_);
  thresholdLabel->setBuddy(threshold_);
  // On high-resolution displays letters are a little wider than Qt expects, and the last one was cut off.
  thresholdLabel->ensurePolished();
  thresholdLabel->setMinimumWidth(thresholdLabel->sizeHint().width() + 4);
  auto* fields = new QHBoxLayout;
  fields->addWidget(partLabel);
  fields->addWidget(subject_, 1);
  fields->addWidget(thresholdLabel);
  fields->addWidget(threshold_);
  auto* below = new QHBoxLayout;
  below->addWidget(note_, 1);
  below->addWidget(export_);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(8, 6, 8, 6);
  column->setSpacing(4);
  column->addLayout(fields);
  column->addWidget(table_, 1);
  column->addLayout(below);
  connect(&search_, &ClearanceSearch::changed, this, &ClearancePanel::showClearances);
  connect(&search_, &ClearanceSearch::failed, this, &ClearancePanel::failed);
  // Else what is selected could not be told from the pair.
  connect(&context.selection, &Selection::changed, table_, &QTableView::clearSelection);
  clearRowsByEscape(*table_, *window);
  connect(&context.hand, &HandState::snapshotShown, &search_, &ClearanceSearch::showSnapshot);
  connect(&view_.poses(), &ShownPoses::changed, this, &ClearancePanel::followMoving);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { showSubjects(); });
  showSubjects();
  showClearances();
}

void ClearancePanel::setUpFields() {
  subject_ = new QComboBox(this);
  subject_->setObjectName(QStringLiteral("clearancePart"));
  subject_->setToolTip(tr("The part whose clearances to all other visible parts are listed"));
  subject_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  connect(subject_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this] {
    const QVariant id = subject_->currentData();
    search_.setSubject(id.isValid() ? std::optional(PartId{id.toUInt()}) : std::nullopt);
  });
  threshold_ = new NumberField(this);
  threshold_->setObjectName(QStringLiteral("clearanceThreshold"));
  threshold_->setTrimmed(true);
  threshold_->setActingAtOnce();
  threshold_->setLength(kThresholdDecimals);
  threshold_->setQuantityRange(0.0, kMaxThreshold);
  threshold_->setQuantityStep(kThresholdStep);
  threshold_->setHelp(tr("Pairs nearer than this are marked as too near"));
  threshold_->showQuantity(keptThreshold());
  model_->setThreshold(threshold_->quantity());
  connect(threshold_, &NumberField::quantityEdited, this, [this](double metres) {
    model_->setThreshold(metres);
    QSettings().setValue(kThresholdKey, metres / kMillimetre);
    showClearances();
  });
}

void ClearancePanel::setUpTable() {
  sorted_ = new QSortFilterProxyModel(this);
  sorted_->setSourceModel(model_);
  sorted_->setSortRole(ClearanceModel::kSortRole);
  sorted_->setSortCaseSensitivity(Qt::CaseInsensitive);
  table_ = new QTableView(this);
  table_->setObjectName(QStringLiteral("clearanceTable"));
  table_->setAccessibleName(tr("Clearances"));
  table_->setModel(sorted_);
  setUpRowTable(*table_);
  keepColumnsApart(*table_);
  table_->sortByColumn(ClearanceModel::Distance, Qt::AscendingOrder);
  // The panel scrolls where there is no room for the header and two rows.
  table_->setMinimumSize(forFont(*table_, 360), forFont(*table_, 78));
  table_->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table_->horizontalHeader()->setSectionResizeMode(ClearanceModel::Other, QHeaderView::Stretch);
  table_->horizontalHeader()->setHighlightSections(false);
  connect(table_->selectionModel(), &QItemSelectionModel::selectionChanged, this, &ClearancePanel::choose);
}

void ClearancePanel::showSubjects() {
  const Scene& scene = session_.scene();
  const bool isSameScene = std::exchange(sceneSerial_, session_.sceneSerial()) == session_.sceneSerial();
  const QVariant before = isSameScene ? subject_->currentData() : QVariant();
  QStringList names, shown;
  const Part* moving = scene.movingPart() ? scene.find(*scene.movingPart()) : nullptr;
  const Group* group = scene.movingGroup() ? scene.findGroup(*scene.movingGroup()) : nullptr;
  names << (group != nullptr    ? tr("In hand: group %1").arg(QString::fromStdString(group->name))
            : moving != nullptr ? tr("In hand: %1").arg(QString::fromStdString(moving->name))
                                : tr("In hand (none)"));
  for (const Scene::PartPtr& part : scene.parts())
    names << QString::fromStdString(part->name);
  for (int i = 0; i < subject_->count(); ++i)
    shown << subject_->itemText(i);
  if (names == shown && isSameScene) return;
  const QSignalBlocker blocker(subject_);
  subject_->clear();
  subject_->addItem(names.first());
  for (const Scene::PartPtr& part : scene.parts())
    subject_->addItem(QString::fromStdString(part->name), static_cast<uint>(part->id));
  const int index = before.isValid() ? subject_->findData(before) : 0;
  subject_->setCurrentIndex(std::max(index, 0));
  if (index < 0 || !isSameScene) search_.setSubject(std::nullopt);
}

void ClearancePanel::showClearances() {
  model_->show(search_.clearances(), search_.scene());
  export_->setEnabled(model_->rowCount() > 0);
  showNote();
  showPair();
}

void ClearancePanel::showNote() {
  const bool hasRows = model_->rowCount() > 0;
  QString note;
  if (!search_.subject()) {
    note = tr("Choose a part, or take one in hand.");
  } else if (!hasRows) {
    note = session_.scene().parts().size() > 1
               ? tr("No other part is visible, or the search is not finished yet.")
               : tr("There is no other part.");
  } else if (const std::optional<PartClearance> pair = chosen(); !pair) {
    note = tr("Select a row to see where the two parts are nearest.");
  } else if (pair->isTouching) {
    note = tr("The two parts touch, within rounding.");
  } else if (!pair->isOverlapping()) {
    note = tr("The line in the view joins the nearest points of the two parts.");
  }
  note_->setText(note);
}

std::optional<PartClearance> ClearancePanel::chosen() const {
  const QModelIndexList rows = table_->selectionModel()->selectedRows();
  if (rows.isEmpty() || !isVisible()) return std::nullopt;
  return model_->at(sorted_->mapToSource(rows.first()).row());
}

void ClearancePanel::choose() {
  const std::optional<PartClearance> pair = chosen();
  if (pair) view_.fitParts({pair->part, pair->other});
  showNote();
  showPair();
}

void ClearancePanel::showPair() {
  const std::optional<PartClearance> pair = chosen();
  if (!pair && !isPairShown_) return;
  isPairShown_ = pair.has_value();
  if (pair && !isBehindReplay()) {
    segment_.show(pair->partPoint, pair->otherPoint);
    label_->showAt(0.5 * (pair->partPoint + pair->otherPoint), ClearanceModel::valueOf(*pair));
  } else {
    segment_.clear();
    label_->end();
  }
  view_.highlight(pair ? std::vector{pair->part, pair->other} : std::vector<PartId>{});
  view_.requestRender();
}

bool ClearancePanel::isBehindReplay() const {
  const std::optional<PartId> moving = session_.scene().movingPart();
  return moving && view_.poses().isReplayed(*moving) && !search_.isOfPresentPose();
}

void ClearancePanel::followMoving() {
  const std::optional<PartId> moving = session_.scene().movingPart();
  // Other parts may be dragged with it, and only the session knows where they come to.
  if (!moving || view_.poses().isDragged(*moving)) return;
  search_.followMoving();
  if (segment_.isShown() && isBehindReplay()) showPair();
}

void ClearancePanel::refresh() {
  showClearances();
}

void ClearancePanel::exportTable() {
  if (!search_.subject()) return;
  const std::optional<QString> file =
      askForSave({tr("Export clearances"),
                  Preferences::lastFolder() + QStringLiteral("/clearances.csv"),
                  {tr("Tables (*.csv)")},
                  {QStringLiteral("csv")}},
                 this);
  if (!file) return;
  try {
    atomicWrite(toPath(*file), clearanceCsv(search_.scene(), search_.clearances()));
  } catch (...) {
    emit failed(describe(tr("The clearances could not be exported."), std::current_exception()));
    return;
  }
  Preferences::rememberFolderOf(*file);
  emit noted(tr("Exported %1").arg(QFileInfo(*file).fileName()));
}

void ClearancePanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  search_.setWanted(true);
  showPair();
}

void ClearancePanel::hideEvent(QHideEvent* event) {
  QWidget::hideEvent(event);
  search_.setWanted(false);
  showPair();
}

}  // namespace nearfit::ui
