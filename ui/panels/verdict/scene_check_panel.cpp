#include "ui/panels/verdict/scene_check_panel.h"

#include <QAction>
#include <QComboBox>
#include <QEvent>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QItemSelectionModel>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QTableView>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/report/scene_check_export.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/panels/verdict/accept_dialog.h"
#include "ui/panels/verdict/findings_filter.h"
#include "ui/panels/verdict/rules_dialog.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/column_widths.h"
#include "ui/widgets/font_scale.h"
#include "ui/widgets/format.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/row_table.h"
#include "ui/widgets/save_file.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Step of the threshold [m].
constexpr double kCheckThresholdStep = 1e-4;
constexpr int kCheckThresholdDecimals = 4;
constexpr int kCheckPercent = 100;
/// Max widths that names and the other columns ask for [pixels at the usual font]: some 35 and 25 letters, beyond which names
/// only tell parts apart at their end, and a reason is read in its tool tip.
constexpr int kMaxNameWidth = 240, kMaxWordsWidth = 170;
/// Rows of findings that there is room for when the panel opens: enough to compare some, and the view stays the larger.
constexpr int kRowsAtFirst = 6;

/// Room around the marks that the camera goes to, as a share of their size, and their min size as a share of
/// the scene: a tiny clash alone would fill the view without saying where it is.
constexpr double kRoomAround = 0.5, kLeastPlace = 0.02;

QString clashesText(std::size_t clashes, std::size_t allowed) {
  const QString count = clashes == 0   ? SceneCheckPanel::tr("no clash")
                        : clashes == 1 ? SceneCheckPanel::tr("1 clash")
                                       : SceneCheckPanel::tr("%L1 clashes").arg(clashes);
  return allowed > 0 ? SceneCheckPanel::tr("%1 (%L2 allowed)").arg(count).arg(allowed) : count;
}

/// "3 clashes, 2 near, 14 clear; 2 left out by rules".
QString countsText(const SceneCheck& check) {
  const std::size_t clashes = check.count(PairVerdict::Clash),
                    contained = check.count(PairVerdict::Contained);
  const auto allowed = std::ranges::count_if(check.findings, [](const PairFinding& finding) {
    return finding.verdict == PairVerdict::Clash && finding.allowedBy.has_value();
  });
  QStringList counts{clashesText(clashes, static_cast<std::size_t>(allowed))};
  const auto add = [&counts](std::size_t count, const QString& text) {
    if (count > 0) counts << text.arg(count);
  };
  add(contained, SceneCheckPanel::tr("%L1 contained"));
  add(check.count(PairVerdict::Touching), SceneCheckPanel::tr("%L1 touching"));
  add(check.count(PairVerdict::Near), SceneCheckPanel::tr("%L1 near"));
  counts << SceneCheckPanel::tr("%L1 clear").arg(check.count(PairVerdict::Clear));
  QString text = counts.join(QStringLiteral(", "));
  if (!check.leftOut.empty())
    text += SceneCheckPanel::tr("; %L1 left out by rules").arg(check.leftOut.size());
  return text;
}

QString labelOf(const ShownFinding& finding) {
  if (finding.depth) return SceneCheckPanel::tr("depth %1").arg(depthText(finding));
  return finding.verdict == PairVerdict::Near ? formatLength(finding.distance.value_or(0.0))
                                              : nameOf(finding.verdict);
}

/// The comparison with what the user has said since.
std::vector<ComparedFinding> withPresentStates(std::vector<ComparedFinding> compared, const Scene& scene) {
  for (ComparedFinding& finding : compared) {
    const PairRecord* record = scene.findPairRecord(finding.pair);
    if (record == nullptr) continue;
    finding.state = record->state;
    finding.reason = record->reason;
  }
  return compared;
}

}  // namespace

SceneCheckPanel::SceneCheckPanel(const Context& context, QWidget* window)
    : QWidget(window),
      session_(context.session),
      view_(context.view),
      run_({context.session, context.view.poses()}),
      marks_(context.view),
      model_(new PairFindingsModel(this)),
      sorted_(new FindingsFilter(this)),
      table_(new QTableView(this)),
      action_(makeAction(this, "checkScene", tr("Chec&k scene…"), QStringLiteral("check-scene"),
                         QStringLiteral("Ctrl+Shift+M"),
                         tr("Check all pairs of visible parts: which clash, touch or are near"))) {
  setUpFields();
  setUpTable();
  setUpButtons();
  setUpMenu();
  setUpLayout();
  connectRun();
  // Else what is selected could not be told from the pairs.
  connect(&context.selection, &Selection::changed, table_, &QTableView::clearSelection);
  clearRowsByEscape(*table_, *window);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { followSession(); });
  showResult();
  showWork();
}

void SceneCheckPanel::setUpFields() {
  threshold_ = new NumberField(this);
  threshold_->setObjectName(QStringLiteral("sceneCheckThreshold"));
  threshold_->setTrimmed(true);
  threshold_->setLength(kCheckThresholdDecimals);
  threshold_->setQuantityRange(0.0, Preferences::kMaxCheckThreshold);
  threshold_->setQuantityStep(kCheckThresholdStep);
  threshold_->setHelp(tr("Pairs of parts no farther apart than this are listed as near"));
  threshold_->showQuantity(Preferences::checkThreshold());
  connect(threshold_, &NumberField::quantityEdited, this,
          [](double metres) { Preferences::setCheckThreshold(metres); });
  text_ = new QLineEdit(this);
  text_->setObjectName(QStringLiteral("sceneCheckText"));
  text_->setPlaceholderText(tr("Search for a part or a reason"));
  text_->setAccessibleName(tr("Search for a part or a reason"));
  text_->setToolTip(tr("List only findings with this in a part's name or the reason"));
  text_->setClearButtonEnabled(true);
  connect(text_, &QLineEdit::textChanged, this, [this](const QString& text) {
    sorted_->setText(text);
    showState();
  });
  verdicts_ = new QComboBox(this);
  verdicts_->setObjectName(QStringLiteral("sceneCheckVerdicts"));
  verdicts_->setAccessibleName(tr("Verdicts listed"));
  verdicts_->setToolTip(tr("List only findings with this verdict"));
  const std::pair<QString, VerdictFilter> verdicts[] = {
      {tr("All verdicts"), VerdictFilter::All}, {tr("Not allowed"), VerdictFilter::NotAllowed},
      {tr("Clashes"), VerdictFilter::Clashing}, {tr("Touching"), VerdictFilter::Touching},
      {tr("Near"), VerdictFilter::Near},        {tr("Clear now"), VerdictFilter::Clear}};
  for (const auto& [name, verdict] : verdicts)
    verdicts_->addItem(name, static_cast<int>(verdict));
  connect(verdicts_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this] {
    sorted_->setVerdict(static_cast<VerdictFilter>(verdicts_->currentData().toInt()));
    showState();
  });
  changed_ = new QComboBox(this);
  changed_->setObjectName(QStringLiteral("sceneCheckChanges"));
  changed_->setAccessibleName(tr("Changes listed"));
  changed_->setToolTip(tr("List only findings that differ so from the last check"));
  const std::pair<QString, ChangeFilter> changes[] = {{tr("Old and new"), ChangeFilter::All},
                                                      {tr("New since"), ChangeFilter::New},
                                                      {tr("Changed since"), ChangeFilter::Changed},
                                                      {tr("Gone since"), ChangeFilter::Gone}};
  for (const auto& [name, change] : changes)
    changed_->addItem(name, static_cast<int>(change));
  connect(changed_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this] {
    sorted_->setChange(static_cast<ChangeFilter>(changed_->currentData().toInt()));
    showState();
  });
  states_ = new QComboBox(this);
  states_->setObjectName(QStringLiteral("sceneCheckStates"));
  states_->setAccessibleName(tr("States listed"));
  states_->setToolTip(tr("List only findings with this state"));
  states_->addItem(tr("All states"));
  for (const FindingState state : {FindingState::New, FindingState::Accepted, FindingState::Fixed})
    states_->addItem(nameOf(state), static_cast<int>(state));
  connect(states_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this] {
    const QVariant state = states_->currentData();
    sorted_->setState(state.isValid() ? std::optional(static_cast<FindingState>(state.toInt()))
                                      : std::nullopt);
    showState();
  });
}

void SceneCheckPanel::setUpTable() {
  sorted_->setSourceModel(model_);
  table_->setObjectName(QStringLiteral("sceneCheckTable"));
  table_->setAccessibleName(tr("Findings of the scene check"));
  table_->setModel(sorted_);
  setUpRowTable(*table_);
  keepColumnsApart(*table_);
  table_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  table_->sortByColumn(PairFindingsModel::Verdict, Qt::DescendingOrder);
  table_->setMinimumSize(forFont(*table_, 360), forFont(*table_, 60));
  // Labels that wrap make the pane around the panel as high as the panel would like to be: the table gives way instead,
  // and scrolls by itself.
  table_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Ignored);
  QHeaderView* header = table_->horizontalHeader();
  header->setMinimumSectionSize(forFont(*table_, 60));
  header->setHighlightSections(false);
  // What is left to judge is seen beside the verdict, also where the numbers need a scroll bar.
  header->moveSection(PairFindingsModel::State, PairFindingsModel::Distance);
  const ColumnWidths::Column names{forFont(*table_, kMaxNameWidth), true},
      words{forFont(*table_, kMaxWordsWidth), false};
  std::vector<ColumnWidths::Column> columns(PairFindingsModel::ColumnCount, words);
  columns[PairFindingsModel::First] = columns[PairFindingsModel::Second] = names;
  new ColumnWidths(*table_, columns);
  connect(table_->selectionModel(), &QItemSelectionModel::selectionChanged, this, &SceneCheckPanel::choose);
  connect(table_, &QTableView::activated, this, &SceneCheckPanel::framePlace);
}

QPushButton* SceneCheckPanel::button(const char* name, const QString& text, const QString& help) {
  auto* made = new QPushButton(text, this);
  made->setObjectName(QLatin1String(name));
  made->setToolTip(help);
  return made;
}

void SceneCheckPanel::setUpButtons() {
  check_ = button("runSceneCheck", tr("Chec&k"),
                  tr("Check all pairs of visible parts, also while a part is felt"));
  check_->setIcon(icon(QStringLiteral("check-scene")));
  cancel_ = button("cancelSceneCheck", tr("Cancel"), tr("Give up the check; the last result stays"));
  rules_ = button("sceneCheckRules", tr("R&ules…"),
                  tr("Choose pairs that are left out, meant to touch, or press fits"));
  accept_ = button("acceptFinding", tr("&Accept…"), tr("Say why the chosen findings may stay"));
  fixed_ = button("fixFinding", tr("Fi&xed"), tr("Mark the chosen findings as fixed"));
  reopen_ = button("reopenFinding", tr("&Reopen"), tr("Mark the chosen findings as new again"));
  ruleForPair_ = button("ruleForPair", tr("Rule for pair…"),
                        tr("Add a rule for the two parts: leave them out, or allow what was found"));
  export_ = button("exportSceneCheck", tr("Export table…"),
                   tr("Export the findings as nearfit-cli clearance --all does (CSV, JSON)"));
  export_->setIcon(icon(QStringLiteral("export")));
  connect(check_, &QPushButton::clicked, this, &SceneCheckPanel::check);
  connect(cancel_, &QPushButton::clicked, &run_, &SceneCheckRun::cancel);
  connect(rules_, &QPushButton::clicked, this, [this] { askRules(); });
  connect(accept_, &QPushButton::clicked, this, &SceneCheckPanel::accept);
  connect(fixed_, &QPushButton::clicked, this, [this] { setState(FindingState::Fixed); });
  connect(reopen_, &QPushButton::clicked, this, [this] { setState(FindingState::New); });
  connect(ruleForPair_, &QPushButton::clicked, this, &SceneCheckPanel::addRuleForPair);
  connect(export_, &QPushButton::clicked, this, &SceneCheckPanel::exportTable);
}

void SceneCheckPanel::setUpMenu() {
  table_->setContextMenuPolicy(Qt::ActionsContextMenu);
  auto* frame = new QAction(tr("Show the place"), table_);
  connect(frame, &QAction::triggered, this, &SceneCheckPanel::framePlace);
  table_->addAction(frame);
  for (QPushButton* each : {accept_, fixed_, reopen_, ruleForPair_}) {
    auto* entry = new QAction(each->text(), table_);
    connect(entry, &QAction::triggered, each, &QPushButton::click);
    table_->addAction(entry);
  }
}

void SceneCheckPanel::setUpLayout() {
  progress_ = new QProgressBar(this);
  progress_->setObjectName(QStringLiteral("sceneCheckProgress"));
  progress_->setRange(0, kCheckPercent);
  progress_->setAccessibleName(tr("Progress of the check"));
  summary_ = new QLabel(this);
  summary_->setObjectName(QStringLiteral("sceneCheckSummary"));
  note_ = new QLabel(this);
  note_->setObjectName(QStringLiteral("sceneCheckNote"));
  for (QLabel* label : {summary_, note_}) {
    label->setTextFormat(Qt::PlainText);
    label->setWordWrap(true);
    // Else the table would change its height with each row that is chosen.
    label->setMinimumHeight(label->fontMetrics().lineSpacing());
  }
  summary_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  auto* thresholdLabel = new QLabel(tr("Thresh&old"), this);
  thresholdLabel->setBuddy(threshold_);
  // Two rows: the panel is as wide as the view, between those at the sides.
  auto* top = new QHBoxLayout;
  top->addWidget(thresholdLabel);
  top->addWidget(threshold_);
  top->addWidget(check_);
  top->addWidget(rules_);
  top->addWidget(summary_, 2);
  top->addWidget(progress_, 1);
  top->addWidget(cancel_);
  auto* filters = new QHBoxLayout;
  filters->addWidget(text_, 1);
  filters->addWidget(verdicts_);
  filters->addWidget(changed_);
  filters->addWidget(states_);
  auto* buttons = new QHBoxLayout;
  buttons->addStretch(1);
  for (QPushButton* each : {accept_, fixed_, reopen_, ruleForPair_, export_})
    buttons->addWidget(each);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(8, 6, 8, 6);
  column->setSpacing(4);
  column->addLayout(top);
  column->addLayout(filters);
  column->addWidget(table_, 1);
  column->addLayout(buttons);
  // Beside the buttons it would wrap to several lines.
  column->addWidget(note_);
}

void SceneCheckPanel::connectRun() {
  connect(&run_, &SceneCheckRun::changed, this, &SceneCheckPanel::showResult);
  connect(&run_, &SceneCheckRun::staleChanged, this, [this] {
    model_->setStale(run_.isStale());
    showState();
  });
  connect(&run_, &SceneCheckRun::workChanged, this, &SceneCheckPanel::showWork);
  connect(&run_, &SceneCheckRun::failed, this, &SceneCheckPanel::failed);
  connect(&run_, &SceneCheckRun::progressed, progress_,
          [this](double fraction) { progress_->setValue(qRound(kCheckPercent * fraction)); });
  // Marks are of where the parts were.
  connect(&view_.poses(), &ShownPoses::changed, this, [this] {
    if (!marks_.isShown()) return;
    const std::optional<int> row = markedRow();
    if (!row || !run_.isAsChecked(model_->at(*row).pair)) showPairs();
  });
}

void SceneCheckPanel::begin() {
  (run_.isRunning() ? cancel_ : check_)->setFocus(Qt::ShortcutFocusReason);
}

void SceneCheckPanel::check() {
  threshold_->settle();
  if (!threshold_->isFaulty()) run_.start(threshold_->quantity());
}

void SceneCheckPanel::showResult() {
  const std::vector<PartPair> chosen = chosenPairs();
  shown_ = run_.checked();
  const Scene& scene = session_.scene();
  if (shown_ != nullptr) {
    model_->show(shownFindings(shown_->scene, shown_->check, shown_->compared));
    shownRecords_.clear();
  } else {
    shownRecords_ = scene.pairRecords();
    model_->show(shownRecords(scene));
  }
  model_->follow(scene);
  model_->setStale(run_.isStale());
  chooseRowsOf(chosen);
  showState();
  showPairs();
}

void SceneCheckPanel::followSession() {
  // The run has told of another scene before.
  if (shown_ == nullptr && session_.scene().pairRecords() != shownRecords_) {
    const auto isSamePair = [](const PairRecord& a, const PairRecord& b) { return a.pair == b.pair; };
    const bool areSamePairs = std::ranges::equal(session_.scene().pairRecords(), shownRecords_, isSamePair);
    if (!areSamePairs) return showResult();
    shownRecords_ = session_.scene().pairRecords();
  }
  model_->follow(session_.scene());
  showState();
  showPairs();
}

void SceneCheckPanel::showWork() {
  const bool isRunning = run_.isRunning();
  // The button that was pressed is gone then: keys go on where the check is begun or ended.
  const bool hadFocus = check_->hasFocus() || cancel_->hasFocus();
  progress_->setValue(0);
  progress_->setVisible(isRunning);
  cancel_->setVisible(isRunning);
  check_->setEnabled(!isRunning);
  if (hadFocus) (isRunning ? cancel_ : check_)->setFocus();
  showState();
}

QString SceneCheckPanel::summaryText() const {
  if (run_.isRunning()) return tr("Checking all pairs of visible parts…");
  if (shown_ != nullptr) {
    const QString counts = countsText(shown_->check);
    if (run_.isCancelled()) return tr("Cancelled. Before: %1").arg(counts);
    return run_.isStale() ? tr("%1 – before the scene changed").arg(counts) : counts;
  }
  if (run_.isCancelled()) return tr("Cancelled.");
  if (model_->rowCount() > 0) return tr("Findings of the last check: %L1").arg(model_->rowCount());
  return tr("The scene was not checked yet.");
}

QString SceneCheckPanel::noteText() const {
  if (run_.isRunning()) return {};
  if (run_.isStale()) return tr("The scene has changed since it was checked: check it again.");
  if (model_->rowCount() == 0)
    return shown_ == nullptr
               ? tr("Check finds each pair of parts that clashes, touches or is near.")
               : tr("No two visible parts are within %1.").arg(formatRoundLength(shown_->check.threshold));
  if (sorted_->rowCount() == 0) return tr("No finding is as the filters say.");
  const std::optional<int> row = markedRow();
  if (shown_ != nullptr && (!row || !model_->at(*row).isKept)) {
    if (const std::size_t count = findingsNotKept(shown_->compared); count > 0)
      return tr("A scene keeps %L1 findings: %L2 of the least cannot be accepted, and will be new in the "
                "next check.")
          .arg(kMaxPairRecords)
          .arg(count);
  }
  if (!row) return tr("Select a row to see the two parts; Return goes to the place.");
  const ShownFinding& finding = model_->at(*row);
  if (finding.now == nullptr)
    return finding.change ? tr("It is gone: nothing is left to see.")
                          : tr("Check the scene again to see where it is.");
  if (finding.depth) return tr("The arrow is a way that frees %1.").arg(finding.part);
  if (finding.now->clash) return tr("No way out was found that frees %1.").arg(finding.part);
  return tr("The line in the view joins the nearest points of the two parts.");
}

void SceneCheckPanel::showState() {
  const std::vector<int> rows = chosenRows();
  const bool areKept =
      !rows.empty() && std::ranges::all_of(rows, [this](int row) { return model_->at(row).isKept; });
  const auto isAny = [&](FindingState state, bool isThat) {
    return areKept &&
           std::ranges::any_of(rows, [&](int row) { return (model_->at(row).state == state) == isThat; });
  };
  accept_->setEnabled(areKept);
  fixed_->setEnabled(isAny(FindingState::Fixed, false));
  reopen_->setEnabled(isAny(FindingState::New, false));
  ruleForPair_->setEnabled(rows.size() == 1);
  export_->setEnabled(shown_ != nullptr && !writing_.isRunning());
  const QList<QPushButton*> buttons{accept_, fixed_, reopen_, ruleForPair_};
  for (int i = 0; i < buttons.size(); ++i)
    table_->actions().at(i + 1)->setEnabled(buttons[i]->isEnabled());
  table_->actions().constFirst()->setEnabled(!rows.empty());
  summary_->setText(summaryText());
  summary_->setEnabled(!run_.isStale() || run_.isRunning());
  note_->setText(noteText());
}

std::vector<int> SceneCheckPanel::chosenRows() const {
  std::vector<int> sortedRows;
  for (const QModelIndex& index : table_->selectionModel()->selectedRows())
    sortedRows.push_back(index.row());
  std::ranges::sort(sortedRows);
  std::vector<int> rows;
  for (const int row : sortedRows)
    rows.push_back(sorted_->mapToSource(sorted_->index(row, 0)).row());
  return rows;
}

std::vector<PartPair> SceneCheckPanel::chosenPairs() const {
  std::vector<PartPair> pairs;
  for (const int row : chosenRows())
    pairs.push_back(model_->at(row).pair);
  return pairs;
}

std::optional<int> SceneCheckPanel::markedRow() const {
  const std::vector<int> rows = chosenRows();
  if (rows.empty() || !isVisible()) return std::nullopt;
  const QModelIndex current = table_->selectionModel()->currentIndex();
  const int row = current.isValid() ? sorted_->mapToSource(current).row() : rows.front();
  return std::ranges::find(rows, row) != rows.end() ? row : rows.front();
}

std::vector<PartId> SceneCheckPanel::chosenParts() const {
  std::vector<PartId> parts;
  for (const PartPair& pair : chosenPairs()) {
    parts.push_back(pair.part);
    parts.push_back(pair.other);
  }
  return parts;
}

void SceneCheckPanel::choose() {
  if (isRestoring_) return;
  const std::vector<PartId> parts = chosenParts();
  if (!parts.empty() && isVisible()) view_.fitParts(parts);
  showState();
  showPairs();
}

void SceneCheckPanel::framePlace() {
  const std::optional<int> row = markedRow();
  const PairFinding* now = row ? model_->at(*row).now : nullptr;
  if (now == nullptr || !run_.isAsChecked(now->pair)) return;
  Aabb box = markedBox(*now);
  if (box.isEmpty()) return;
  const double room = std::max(kRoomAround * box.diagonal(), kLeastPlace * view_.visibleBounds().diagonal());
  box.lower -= room;
  box.upper += room;
  view_.fitBox(box);
}

void SceneCheckPanel::showPairs() {
  const std::optional<int> row = markedRow();
  if (!row && !isPairShown_) return;
  isPairShown_ = row.has_value();
  const ShownFinding* finding = row ? &model_->at(*row) : nullptr;
  const bool hasPlace = finding != nullptr && finding->now != nullptr && run_.isAsChecked(finding->pair);
  hasPlace ? marks_.show(*finding->now, labelOf(*finding)) : marks_.clear();
  view_.highlight(finding != nullptr ? chosenParts() : std::vector<PartId>{});
  view_.requestRender();
}

void SceneCheckPanel::chooseRowsOf(const std::vector<PartPair>& pairs) {
  // The camera stays where it is.
  isRestoring_ = true;
  table_->clearSelection();
  QItemSelection selection;
  for (int row = 0; row < sorted_->rowCount(); ++row) {
    const QModelIndex index = sorted_->index(row, 0);
    const PartPair& pair = model_->at(sorted_->mapToSource(index).row()).pair;
    if (std::ranges::find(pairs, pair) != pairs.end()) selection.select(index, index);
  }
  table_->selectionModel()->select(selection,
                                   QItemSelectionModel::ClearAndSelect | QItemSelectionModel::Rows);
  isRestoring_ = false;
}

void SceneCheckPanel::setState(FindingState state, const QString& reason) {
  try {
    session_.setFindingState(chosenPairs(), state, reason.toStdString());
  } catch (...) {
    emit failed(describe(tr("The state of the findings could not be changed."), std::current_exception()));
  }
}

void SceneCheckPanel::accept() {
  const std::vector<int> rows = chosenRows();
  if (rows.empty()) return;
  const auto reason = askForReason(static_cast<int>(rows.size()), model_->at(rows.front()).reason, this);
  if (reason) setState(FindingState::Accepted, *reason);
}

void SceneCheckPanel::askRules(const std::optional<PairRule>& added) {
  const auto rules = askForRules(session_.scene(), added, this);
  if (!rules) return;
  try {
    session_.setPairRules(*rules);
  } catch (...) {
    emit failed(describe(tr("The rules could not be changed."), std::current_exception()));
  }
}

void SceneCheckPanel::addRuleForPair() {
  const std::vector<int> rows = chosenRows();
  if (rows.size() != 1) return;
  const ShownFinding& finding = model_->at(rows.front());
  PairRule rule;
  rule.kind = finding.verdict == PairVerdict::Touching ? PairRuleKind::Touching : PairRuleKind::LeaveOut;
  rule.part = patternOf(finding.part.toStdString());
  rule.other = patternOf(finding.other.toStdString());
  askRules(rule);
}

void SceneCheckPanel::exportTable() {
  if (shown_ == nullptr || writing_.isRunning()) return;
  const std::optional<QString> file =
      askForSave({tr("Export the scene check"),
                  Preferences::lastFolder() + QStringLiteral("/scene-check.csv"),
                  {tr("Tables (*.csv)"), tr("JSON files (*.json)")},
                  {QStringLiteral("csv"), QStringLiteral("json")}},
                 this);
  // Another scene may have been opened meanwhile.
  if (!file || shown_ == nullptr) return;
  const bool isJson = QFileInfo(*file).suffix().compare(QStringLiteral("json"), Qt::CaseInsensitive) == 0;
  const auto job = [checked = shown_, compared = withPresentStates(shown_->compared, session_.scene()),
                    isJson, path = toPath(*file)](const ProgressCallback&) {
    atomicWrite(path, isJson ? sceneCheckJson(checked->scene, checked->check, compared)
                             : sceneCheckCsv(checked->scene, checked->check, compared));
  };
  writing_.run(job, [this, file = *file](const std::exception_ptr& error) {
    showState();
    if (error) return emit failed(describe(tr("The findings could not be exported."), error));
    Preferences::rememberFolderOf(file);
    emit noted(tr("Exported %1").arg(QFileInfo(file).fileName()));
  });
  showState();
}

void SceneCheckPanel::refresh() {
  model_->refresh();
  showState();
  showPairs();
}

QSize SceneCheckPanel::sizeHint() const {
  const int rows = table_->horizontalHeader()->sizeHint().height() +
                   kRowsAtFirst * table_->verticalHeader()->defaultSectionSize();
  return QWidget::sizeHint() + QSize(0, std::max(rows - table_->minimumHeight(), 0));
}

void SceneCheckPanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  showState();
  showPairs();
}

void SceneCheckPanel::hideEvent(QHideEvent* event) {
  QWidget::hideEvent(event);
  showPairs();
}

void SceneCheckPanel::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  // Marks are in the colours of the theme.
  if (event->type() == QEvent::PaletteChange && isPairShown_) showPairs();
}

}  // namespace nearfit::ui
