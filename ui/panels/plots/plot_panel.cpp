#include "ui/panels/plots/plot_panel.h"

#include <QComboBox>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLabel>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <limits>
#include <utility>

#include "core/files/atomic_write.h"
#include "ui/panels/plots/plot_view.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/picture_file.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/save_file.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr double kAll = std::numeric_limits<double>::infinity();
constexpr double kSpans[] = {2.0, 10.0, 30.0, 60.0, kAll};
constexpr int kFirstSpan = 1;

}  // namespace

PlotPanel::PlotPanel(QWidget* parent) : QWidget(parent), view_(new PlotView(this)) {
  setUpButtons();
  auto* row = new QHBoxLayout;
  for (QWidget* each :
       {static_cast<QWidget*>(pause_), static_cast<QWidget*>(follow_), static_cast<QWidget*>(span_)})
    row->addWidget(each);
  row->addWidget(note_, 1);
  for (QWidget* each : {static_cast<QWidget*>(table_), static_cast<QWidget*>(picture_)})
    row->addWidget(each);
  row->setContentsMargins(6, 4, 6, 0);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(2);
  column->addLayout(row);
  column->addWidget(view_, 1);
  connect(view_, &PlotView::followingChanged, this,
          [this](bool isFollowing) { follow_->setEnabled(!isFollowing); });
  showLive();
}

PlotPanel::~PlotPanel() = default;

void PlotPanel::setUpButtons() {
  const auto make = [this](const char* name, const QString& text, const char* iconName, const QString& tip) {
    auto* button = new QToolButton(this);
    button->setObjectName(QLatin1String(name));
    button->setText(text);
    button->setIcon(icon(QLatin1String(iconName)));
    button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    button->setAutoRaise(true);
    button->setFocusPolicy(Qt::TabFocus);
    button->setToolTip(tip);
    return button;
  };
  pause_ = make("pausePlots", tr("Pause"), "pause", tr("Freeze the plots; samples are still kept"));
  pause_->setCheckable(true);
  connect(pause_, &QToolButton::toggled, this, &PlotPanel::setPaused);
  follow_ = make("followPlots", tr("Follow"), "fit",
                 tr("Show the newest samples again, after zooming (wheel) or dragging"));
  follow_->setEnabled(false);
  connect(follow_, &QToolButton::clicked, this, &PlotPanel::followAgain);
  span_ = new QComboBox(this);
  span_->setObjectName(QStringLiteral("plotSpan"));
  span_->setAccessibleName(tr("Time shown"));
  span_->setToolTip(tr("Time shown"));
  for (const double span : kSpans)
    span_->addItem(span == kAll ? tr("All") : tr("%1 s").arg(span), span);
  span_->setCurrentIndex(kFirstSpan);
  connect(span_, QOverload<int>::of(&QComboBox::activated), this, &PlotPanel::followAgain);
  table_ = make("exportPlotTable", tr("Table…"), "export", tr("Export the samples of the time shown (CSV)"));
  connect(table_, &QToolButton::clicked, this, &PlotPanel::exportTable);
  picture_ = make("exportPlotPicture", tr("Picture…"), "export", tr("Export the plots as a picture (PNG)"));
  connect(picture_, &QToolButton::clicked, this, &PlotPanel::exportPicture);
  note_ = new QLabel(this);
  note_->setObjectName(QStringLiteral("plotNote"));
}

const PlotHistory& PlotPanel::shown() const {
  return recording_ ? *recording_ : paused_ ? *paused_ : live_;
}

void PlotPanel::add(const std::vector<MotionRow>& rows, quint64 lost) {
  // A new run begins, with no ticks missing so far.
  const bool isNewRun = !rows.empty() && rows.front().time < live_.endTime();
  for (const MotionRow& row : rows)
    live_.add(plotSample(row));
  if (lost > 0) live_.addGap();
  const quint64 before = std::exchange(lost_, (isNewRun ? 0 : lost_) + lost);
  if (lost_ != before) showNote();
  if (&shown() == &live_) view_->refresh();
}

void PlotPanel::showNote() {
  QStringList notes;
  if (recording_) notes << tr("Recording");
  if (!recording_ && paused_) notes << tr("Paused");
  if (!recording_ && lost_ > 0) notes << tr("%1 ticks are missing: the window was busy").arg(lost_);
  note_->setText(notes.join(QStringLiteral("; ")));
}

void PlotPanel::setPaused(bool isPaused) {
  if (isPaused) {
    paused_ = live_;
  }
  view_->setHistory(nullptr);
  if (!isPaused) paused_.reset();
  view_->setHistory(&shown());
  showNote();
}

void PlotPanel::followAgain() {
  view_->follow(span_->currentData().toDouble());
}

void PlotPanel::showRecording(const std::vector<MotionRow>& rows) {
  view_->setHistory(nullptr);
  recording_.emplace(std::max<std::size_t>(rows.size(), 1));
  for (const MotionRow& row : rows)
    recording_->add(plotSample(row));
  pause_->setEnabled(false);
  span_->setCurrentIndex(span_->findData(kAll));
  showNote();
  view_->setHistory(&*recording_);
  followAgain();
}

void PlotPanel::setRecordingTime(double time) {
  if (recording_) view_->setCursorTime(time);
}

void PlotPanel::showLive() {
  view_->setHistory(nullptr);
  recording_.reset();
  pause_->setEnabled(true);
  span_->setCurrentIndex(kFirstSpan);
  showNote();
  view_->setCursorTime({});
  view_->setHistory(&shown());
  followAgain();
}

QString PlotPanel::askForFile(const QString& title, const QString& suffix) {
  return askForSave({title,
                     Preferences::lastFolder() + QStringLiteral("/felt.") + suffix,
                     {tr("%1 files (*.%2)").arg(suffix.toUpper(), suffix)},
                     {suffix}},
                    this)
      .value_or(QString());
}

void PlotPanel::exportTable() {
  const QCPRange range = view_->timeRange();
  const std::string text = shown().csv(range.lower, range.upper);
  const QString file = askForFile(tr("Export samples"), QStringLiteral("csv"));
  if (file.isEmpty()) return;
  try {
    atomicWrite(toPath(file), text);
    Preferences::rememberFolderOf(file);
    emit noted(tr("Exported %1").arg(QFileInfo(file).fileName()));
  } catch (...) {
    emit failed(describe(tr("The samples could not be exported."), std::current_exception()));
  }
}

void PlotPanel::exportPicture() {
  const QPixmap pixmap = view_->toPixmap();
  const QString file = askForFile(tr("Export picture"), QStringLiteral("png"));
  if (file.isEmpty()) return;
  try {
    writePicture(pixmap.toImage(), file);
    Preferences::rememberFolderOf(file);
    emit noted(tr("Exported %1").arg(QFileInfo(file).fileName()));
  } catch (...) {
    emit failed(describe(tr("The picture could not be exported."), std::current_exception()));
  }
}

}  // namespace nearfit::ui
