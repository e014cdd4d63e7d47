#include "ui/shell/title_and_status.h"

#include <QAction>
#include <QHBoxLayout>
#include <QHelpEvent>
#include <QLabel>
#include <QMainWindow>
#include <QStyleOption>
#include <QStylePainter>
#include <QThread>
#include <QTimer>
#include <QToolTip>
#include <algorithm>
#include <ranges>
#include <vector>

#include <glm/geometric.hpp>

#include "core/session/session.h"
#include "ui/model/hand_state.h"
#include "ui/model/min_distance.h"
#include "ui/widgets/format.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr int kNoteTime = 8000;  ///< [ms]

/// True if the poses differ by more than rounding.
bool isElsewhere(const RigidTransform& a, const RigidTransform& b) {
  constexpr double kSlack = 1e-9;  ///< [m]; for rotations half the angle [rad].
  const glm::dquat turn = glm::conjugate(a.rotation) * b.rotation;
  return glm::distance(a.translation, b.translation) > kSlack ||
         glm::length(glm::dvec3(turn.x, turn.y, turn.z)) > kSlack;
}

const QString kSheet = QStringLiteral("border-left: 1px solid #d5dbe1; padding-left: 8px");

void setColour(QLabel& label, const QColor& colour) {
  label.setStyleSheet(kSheet + QStringLiteral("; color: %1").arg(colour.name()));
}

/// Shows a number as present, or in the grey of what is disabled: a colour in its sheet would cover that.
void setPresent(QLabel& label, bool isPresent) {
  if (label.isEnabled() == isPresent) return;
  label.setEnabled(isPresent);
  isPresent ? setColour(label, colours::kMutedText) : label.setStyleSheet(kSheet);
}

/// Shows a text. The label does not get narrower again, so that numbers beside it stay where they are.
void showText(QLabel& label, const QString& text) {
  if (label.text() == text) return;
  label.setText(text);
  label.setMinimumWidth(std::max(label.minimumWidth(), label.sizeHint().width()));
}

/// Labels side by side. Where there is no room for all of them, the first ones are left out, so that the window can be
/// narrow.
class ReadoutRow : public QWidget {
 public:
  explicit ReadoutRow(QWidget* parent) : QWidget(parent) {
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins({});
    row->setSizeConstraint(QLayout::SetNoConstraint);
    setMinimumWidth(1);
  }

  QLabel* addLabel(const QString& objectName, const QString& widest) {
    auto* label = new QLabel(this);
    label->setObjectName(objectName);
    label->setMinimumWidth(label->fontMetrics().horizontalAdvance(widest) + 14);
    setColour(*label, colours::kMutedText);
    layout()->addWidget(label);
    labels_.push_back(label);
    return label;
  }

  QSize sizeHint() const override {
    int wide = 0;
    for (const QLabel* label : labels_)
      wide += widthOf(*label);
    return {wide, QWidget::sizeHint().height()};
  }

 protected:
  void resizeEvent(QResizeEvent* event) override {
    QWidget::resizeEvent(event);
    leaveOut();
  }
  bool event(QEvent* event) override {
    const bool isHandled = QWidget::event(event);
    // A label may have become wider where the row could not.
    if (event->type() == QEvent::LayoutRequest) leaveOut();
    return isHandled;
  }

 private:
  void leaveOut() {
    int room = width();
    for (QLabel* label : std::views::reverse(labels_)) {
      room -= widthOf(*label);
      label->setVisible(room >= 0);
    }
  }
  int widthOf(const QLabel& label) const {
    return std::max(label.minimumWidth(), label.sizeHint().width()) + layout()->spacing();
  }

  std::vector<QLabel*> labels_;
};

}  // namespace

WindowTitle::WindowTitle(Session& session, const HandState& hand, QMainWindow* window)
    : QObject(window), session_(session), hand_(hand), window_(window) {
  connect(&hand_, &HandState::changed, this, &WindowTitle::showModified);
  connect(&hand_, &HandState::snapshotShown, this, &WindowTitle::showModified);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { show(); });
  show();
}

void WindowTitle::show() {
  const QString name = session_.file().empty() ? tr("Untitled") : fromPath(session_.file().filename());
  window_->setWindowTitle(name + QStringLiteral("[*] – Nearfit"));
  showModified();
}

void WindowTitle::showModified() {
  const std::optional<PartId> part = hand_.part();
  const Part* held = part ? session_.scene().find(*part) : nullptr;
  const bool hasMoved = held != nullptr && isElsewhere(hand_.partPose(), held->worldFromPart);
  const bool isModified = session_.isModified() || hasMoved;
  if (window_->isWindowModified() != isModified) window_->setWindowModified(isModified);
}

NoteBar::NoteBar(Session& session, QWidget* parent) : QStatusBar(parent), session_(session) {
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] {
    if (state_ && *state_ != session_.stateSerial()) endNote();
  });
}

void NoteBar::note(const QString& text) {
  showMessage(text, kNoteTime);
  state_.reset();
  loopLevel_ = QThread::currentThread()->loopLevel();
  QTimer::singleShot(0, this, [this] { state_ = session_.stateSerial(); });
}

void NoteBar::endAtCommandsOf(const QMainWindow& window) {
  for (const QAction* action : window.findChildren<QAction*>())
    connect(action, &QAction::triggered, this, &NoteBar::endNoteOfOtherCommand);
}

void NoteBar::endNoteOfOtherCommand() {
  // A command hears of its trigger before this does. One that runs dialogs has notes from their event loops.
  const int level = QThread::currentThread()->loopLevel();
  if (loopLevel_ > level)
    loopLevel_ = level;
  else
    endNote();
}

void NoteBar::endNote() {
  // The command may itself have noted something just now.
  if (state_) clearMessage();
}

QRect NoteBar::room() const {
  constexpr int kMargin = 6;
  int right = width() - 2 * kMargin;
  for (const QObject* child : children()) {
    const auto* widget = qobject_cast<const QWidget*>(child);
    // A tool tip is a child too, and a window.
    if (widget != nullptr && widget->isVisible() && !widget->isWindow())
      right = std::min(right, widget->x() - kMargin);
  }
  return {kMargin, 0, std::max(right - kMargin, 0), height()};
}

QString NoteBar::shownText() const {
  return fontMetrics().elidedText(currentMessage(), Qt::ElideRight, room().width());
}

bool NoteBar::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip || shownText() == currentMessage()) return QStatusBar::event(event);
  const auto* help = static_cast<const QHelpEvent*>(event);
  if (!room().contains(help->pos())) return QStatusBar::event(event);
  QToolTip::showText(help->globalPos(), currentMessage(), this);
  return true;
}

void NoteBar::paintEvent(QPaintEvent* event) {
  const QString text = shownText();
  if (text == currentMessage()) return QStatusBar::paintEvent(event);
  // Qt would cut it off in the middle of a letter.
  QStylePainter painter(this);
  QStyleOption option;
  option.initFrom(this);
  painter.drawPrimitive(QStyle::PE_PanelStatusBar, option);
  painter.setPen(palette().windowText().color());
  painter.drawText(room(), static_cast<int>(Qt::AlignLeading | Qt::AlignVCenter) | Qt::TextSingleLine, text);
}

StatusReadout::StatusReadout(const HandState& hand, QStatusBar* bar) : QObject(bar), bar_(bar) {
  auto* row = new ReadoutRow(bar);
  row_ = row;
  rate_ = row->addLabel(QStringLiteral("statusRate"), tr("Servo 1000 Hz"));
  lateness_ = row->addLabel(QStringLiteral("statusLateness"), tr("Late 0.00 ms (p99)"));
  minima_ = row->addLabel(QStringLiteral("statusMinima"), tr("Minima 0,000"));
  distance_ = row->addLabel(QStringLiteral("statusDistance"), tr("Min distance 0000 mm"));
  bar->addPermanentWidget(row);
  bar->installEventFilter(this);
  connect(bar, &QStatusBar::messageChanged, this, &StatusReadout::makeRoom);
  connect(&hand, &HandState::statusChanged, this, &StatusReadout::showStatus);
  connect(&hand, &HandState::snapshotDrawn, this,
          [this](const ServoSnapshot& snapshot) { showSnapshot(snapshot, true); });
  connect(&hand, &HandState::snapshotKept, this,
          [this](const ServoSnapshot& snapshot) { showSnapshot(snapshot, false); });
  connect(&hand, &HandState::snapshotCleared, this, &StatusReadout::clearSnapshot);
  showStatus({});
  clearSnapshot();
}

void StatusReadout::showStatus(const ServoStatus& status) {
  showText(*rate_, status.isRunning ? tr("Servo %1 Hz").arg(status.rate, 0, 'f', 0) : tr("Servo off"));
  setColour(*rate_, status.isTooSlow() ? colours::kWarning : colours::kMutedText);
  rate_->setToolTip(status.isTooSlow() ? tr("The servo misses ticks, so contact feels softer than set. "
                                            "Reduce the cutoff, or hide parts that do not matter.")
                                       : QString());
  showText(*lateness_,
           status.isRunning ? tr("Late %1 (p99)").arg(formatDuration(status.latenessP99)) : tr("Late –"));
  setIdle(!status.isRunning, isWithoutNumbers_);
}

void StatusReadout::showSnapshot(const ServoSnapshot& snapshot, bool isFelt) {
  setPresent(*minima_, isFelt);
  setPresent(*distance_, isFelt);
  showText(*minima_, tr("Minima %1").arg(formatMinima(snapshot.lmdCount, snapshot.isTruncated)));
  minima_->setToolTip(explainMinima(snapshot.isTruncated));
  showText(*distance_, tr("Min distance %1").arg(formatMinDistance(minDistanceOf(snapshot))));
  setIdle(isServoOff_, false);
}

void StatusReadout::clearSnapshot() {
  setPresent(*minima_, true);
  setPresent(*distance_, true);
  showText(*minima_, tr("Minima –"));
  minima_->setToolTip({});
  showText(*distance_, tr("Min distance –"));
  setIdle(isServoOff_, true);
}

void StatusReadout::setIdle(bool isServoOff, bool isWithoutNumbers) {
  const bool wasIdle = isIdle();
  isServoOff_ = isServoOff;
  isWithoutNumbers_ = isWithoutNumbers;
  if (isIdle() != wasIdle) makeRoom();
}

void StatusReadout::makeRoom() {
  constexpr int kMargins = 18;
  const QString note = bar_->currentMessage();
  const bool wasShown = !row_->isHidden();
  row_->show();
  // Dashes tell nothing that a note should be cut off for.
  if (isIdle() && !note.isEmpty()) {
    bar_->layout()->activate();
    if (bar_->fontMetrics().horizontalAdvance(note) > row_->x() - kMargins) row_->hide();
  }
  if (row_->isHidden() != wasShown) return;
  bar_->layout()->activate();
  bar_->update();
}

bool StatusReadout::eventFilter(QObject* watched, QEvent* event) {
  const bool isHandled = QObject::eventFilter(watched, event);
  // Once the bar has laid out its widgets.
  if (event->type() == QEvent::Resize) QTimer::singleShot(0, this, &StatusReadout::makeRoom);
  return isHandled;
}

}  // namespace nearfit::ui
