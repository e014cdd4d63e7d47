#include "ui/panels/replay/timeline.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QMenu>
#include <QMouseEvent>
#include <QSignalBlocker>
#include <QSlider>
#include <QStyle>
#include <QStyleOptionSlider>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "ui/panels/replay/timeline_track.h"
#include "ui/widgets/elided_label.h"
#include "ui/widgets/format.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr int kScaleSteps = 100'000;
constexpr double kSpeeds[] = {0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 10.0};
constexpr int kRealTime = 3;
/// Rows that a press with Shift skips: a tenth of a second at 1 kHz.
constexpr int kManyRows = 100;

QString timeText(double time) {
  return QObject::tr("%1 s").arg(formatFixed(time, 3));
}

/// A slider that jumps to where it is pressed, as that of a player does.
class Scale : public QSlider {
 public:
  using QSlider::QSlider;

 protected:
  void mousePressEvent(QMouseEvent* event) override {
    if (event->button() == Qt::LeftButton) {
      QStyleOptionSlider option;
      initStyleOption(&option);
      const QRect handle = style()->subControlRect(QStyle::CC_Slider, &option, QStyle::SC_SliderHandle, this);
      if (!handle.contains(event->pos())) {
        const int room = width() - handle.width();
        setValue(QStyle::sliderValueFromPosition(minimum(), maximum(), event->pos().x() - handle.width() / 2,
                                                 std::max(room, 1)));
      }
    }
    QSlider::mousePressEvent(event);
  }
};

}  // namespace

Timeline::Timeline(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("timelinePanel"));
  setUpButtons();
  setUpScale();
  speed_ = new QComboBox(this);
  speed_->setObjectName(QStringLiteral("timelineSpeed"));
  speed_->setAccessibleName(tr("Speed"));
  speed_->setToolTip(tr("Speed"));
  for (const double speed : kSpeeds)
    speed_->addItem(tr("%L1×").arg(speed), speed);
  speed_->setCurrentIndex(kRealTime);
  connect(speed_, QOverload<int>::of(&QComboBox::activated), this,
          [this] { emit speedChosen(speed_->currentData().toDouble()); });
  name_ = new ElidedLabel(this);
  time_ = new QLabel(this);
  note_ = new QLabel(this);
  name_->setObjectName(QStringLiteral("timelineName"));
  time_->setObjectName(QStringLiteral("timelineTime"));
  note_->setObjectName(QStringLiteral("timelineNote"));
  result_ = new QLabel(this);
  result_->setObjectName(QStringLiteral("timelineResult"));
  result_->setWordWrap(true);
  result_->setTextFormat(Qt::PlainText);
  result_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  QFont numbers = time_->font();
  numbers.setBold(true);
  time_->setFont(numbers);
  time_->setMinimumWidth(time_->fontMetrics().horizontalAdvance(QStringLiteral("0000.000 s / 0000.000 s")));
  auto* row = new QHBoxLayout;
  for (QWidget* each : {static_cast<QWidget*>(open_), static_cast<QWidget*>(back_),
                        static_cast<QWidget*>(play_), static_cast<QWidget*>(forward_)})
    row->addWidget(each);
  row->addWidget(scale_, 1);
  for (QWidget* each :
       {static_cast<QWidget*>(time_), static_cast<QWidget*>(speed_), static_cast<QWidget*>(loop_),
        static_cast<QWidget*>(path_), static_cast<QWidget*>(close_)})
    row->addWidget(each);
  auto* words = new QHBoxLayout;
  words->addWidget(name_, 1);
  words->addWidget(note_, 2);
  words->setSpacing(16);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(8, 4, 8, 6);
  column->setSpacing(2);
  column->addLayout(row);
  column->addWidget(track_);
  column->addLayout(words);
  column->addWidget(result_);
  // A dock would give it a share of the window, most of it empty.
  setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
  showRecording({}, {});
}

void Timeline::setUpScale() {
  scale_ = new Scale(Qt::Horizontal, this);
  scale_->setObjectName(QStringLiteral("timelineScale"));
  scale_->setAccessibleName(tr("Time in the recording"));
  scale_->setRange(0, kScaleSteps);
  scale_->setPageStep(kScaleSteps / 20);
  scale_->setSingleStep(kScaleSteps / 200);
  scale_->installEventFilter(this);
  connect(scale_, &QSlider::valueChanged, this,
          [this](int value) { emit sought(duration_ * value / kScaleSteps); });
  track_ = new TimelineTrack(this);
  connect(track_, &TimelineTrack::sought, this, &Timeline::sought);
}

bool Timeline::eventFilter(QObject* watched, QEvent* event) {
  const bool isPlaced = event->type() == QEvent::Resize || event->type() == QEvent::Move;
  if (watched == scale_ && isPlaced) {
    // A time is below the middle of the handle that shows it.
    QStyleOptionSlider option;
    option.initFrom(scale_);
    const int half = style()->pixelMetric(QStyle::PM_SliderLength, &option, scale_) / 2;
    const int left = layout()->contentsMargins().left();
    track_->setEnds(scale_->x() + half - left, scale_->x() + scale_->width() - half - left);
  }
  return QWidget::eventFilter(watched, event);
}

QToolButton* Timeline::make(const char* name, const QString& text, const char* iconName) {
  auto* button = new QToolButton(this);
  button->setObjectName(QLatin1String(name));
  button->setAccessibleName(text);
  button->setToolTip(text);
  button->setIcon(icon(QLatin1String(iconName)));
  button->setAutoRaise(true);
  button->setFocusPolicy(Qt::TabFocus);
  return button;
}

void Timeline::setUpButtons() {
  open_ = make("timelineOpen", tr("Open a recording"), "open");
  back_ = make("timelineBack", tr("Back one tick (Left; with Shift 100)"), "step-back");
  play_ = make("timelinePlay", tr("Play (Space)"), "start");
  forward_ = make("timelineForward", tr("Forward one tick (Right; with Shift 100)"), "step-forward");
  loop_ = make("timelineLoop", tr("Loop"), "loop");
  loop_->setCheckable(true);
  path_ = make("timelinePath", tr("Path: save, certify or export the motion"), "path");
  path_->setPopupMode(QToolButton::InstantPopup);
  close_ = make("timelineClose", tr("Close the recording and put all parts back (Esc)"), "close");
  connect(open_, &QToolButton::clicked, this, &Timeline::openWanted);
  connect(back_, &QToolButton::clicked, this, [this] { emit stepped(-1); });
  connect(forward_, &QToolButton::clicked, this, [this] { emit stepped(1); });
  connect(play_, &QToolButton::clicked, this, &Timeline::playToggled);
  connect(loop_, &QToolButton::toggled, this, &Timeline::loopingChosen);
  connect(close_, &QToolButton::clicked, this, &Timeline::closeWanted);
}

void Timeline::showRecording(const QString& name, std::span<const MotionRow> rows) {
  duration_ = rows.empty() ? 0.0 : rows.back().time;
  track_->showRows(rows);
  from_ = 0.0;
  to_ = duration_;
  track_->setRange(from_, to_);
  showResult({});
  track_->setVisible(!name.isEmpty());
  const bool isThere = !name.isEmpty();
  for (QWidget* each :
       {static_cast<QWidget*>(back_), static_cast<QWidget*>(play_), static_cast<QWidget*>(forward_),
        static_cast<QWidget*>(loop_), static_cast<QWidget*>(path_), static_cast<QWidget*>(close_),
        static_cast<QWidget*>(scale_), static_cast<QWidget*>(speed_)})
    each->setEnabled(isThere);
  name_->setText(isThere ? name : tr("No recording is open."));
  name_->setToolTip(name);
  if (!isThere) loop_->setChecked(false);
  if (!isThere) speed_->setCurrentIndex(kRealTime);
  showPlaying(false);
  showTime(0.0, {});
}

void Timeline::showRows(std::span<const MotionRow> rows) {
  track_->showRows(rows);
  track_->setTime(shownTime_);
}

void Timeline::setPathMenu(QMenu* menu) {
  path_->setMenu(menu);
}

void Timeline::showResult(const QString& text, std::optional<double> mark) {
  result_->setText(text);
  result_->setVisible(!text.isEmpty());
  track_->setMark(mark);
}

void Timeline::setRange(double from, double to) {
  from = std::max(from, 0.0);
  to = std::min(to, duration_);
  if (!(from < to)) return;
  from_ = from;
  to_ = to;
  track_->setRange(from_, to_);
}

void Timeline::showTime(double time, const QString& note) {
  shownTime_ = time;
  const QSignalBlocker blocker(scale_);
  track_->setTime(time);
  // A dragged slider stays where the mouse is.
  if (!scale_->isSliderDown())
    scale_->setValue(duration_ > 0.0 ? static_cast<int>(std::lround(kScaleSteps * time / duration_)) : 0);
  time_->setText(timeText(time) + QStringLiteral(" / ") + timeText(duration_));
  note_->setText(note);
}

void Timeline::showPlaying(bool isPlaying) {
  play_->setIcon(icon(isPlaying ? QStringLiteral("pause") : QStringLiteral("start")));
  play_->setToolTip(isPlaying ? tr("Pause (Space)") : tr("Play (Space)"));
  play_->setAccessibleName(isPlaying ? tr("Pause") : tr("Play"));
}

void Timeline::keyPressEvent(QKeyEvent* event) {
  const int rows = event->modifiers().testFlag(Qt::ShiftModifier) ? kManyRows : 1;
  if (!play_->isEnabled()) return QWidget::keyPressEvent(event);
  switch (event->key()) {
    case Qt::Key_Space:
      return emit playToggled();
    case Qt::Key_Left:
      return emit stepped(-rows);
    case Qt::Key_Right:
      return emit stepped(rows);
    case Qt::Key_BracketLeft:
      return setRange(shownTime_, to_);
    case Qt::Key_BracketRight:
      return setRange(from_, shownTime_);
    case Qt::Key_Escape:
      return emit closeWanted();
    default:
      QWidget::keyPressEvent(event);
  }
}

}  // namespace nearfit::ui
