#include "ui/panels/feel/feel_notice.h"

#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>

#include "ui/widgets/names.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr double kLongWait = 0.25;  ///< [s]

/// Returns "Base", "Base and Lid" or "Base, Lid and 3 more".
QString namesOf(const ServoSnapshot& snapshot, const Scene& scene) {
  QStringList names;
  const std::size_t stored = std::min<std::size_t>(snapshot.overlappingCount, ServoSnapshot::kMaxOverlapping);
  for (std::size_t i = 0; i < stored; ++i) {
    if (const Part* part = scene.find(snapshot.overlapping[i])) names << QString::fromStdString(part->name);
  }
  constexpr int kNamed = 2;
  return breakable(listOfNames(names, kNamed, static_cast<int>(snapshot.overlappingCount)));
}

}  // namespace

FeelNotice::FeelNotice(QWidget* parent)
    : QFrame(parent), text_(new QLabel(this)), restart_(new QPushButton(tr("Restart"), this)) {
  setObjectName(QStringLiteral("feelNotice"));
  setStyleSheet(QStringLiteral("#feelNotice { background: #fdf0e3; border: 1px solid #e8c39b; "
                               "border-radius: 5px; } #feelNotice QLabel { color: %1; }")
                    .arg(colours::kWarning.name()));
  text_->setObjectName(QStringLiteral("noticeText"));
  text_->setWordWrap(true);
  restart_->setObjectName(QStringLiteral("restart"));
  restart_->setIcon(icon(QStringLiteral("start")));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(9, 7, 9, 7);
  layout->addWidget(text_);
  layout->addWidget(restart_);
  connect(restart_, &QPushButton::clicked, this, &FeelNotice::restartRequested);
  clear();
}

void FeelNotice::clear() {
  waitingSince_ = -1.0;
  hide();
}

void FeelNotice::showSnapshot(const ServoSnapshot& snapshot, const Scene& scene) {
  QString text = textFor(snapshot, scene);
  if (hasWaitedLong(snapshot) && text.isEmpty()) text = tr("Finding out which parts overlap.");
  text_->setText(text);
  restart_->setVisible(snapshot.fault != ServoFault::None);
  setVisible(!text.isEmpty());
  keepTextWhole();
}

void FeelNotice::keepTextWhole() {
  text_->setMinimumHeight(std::max(0, text_->heightForWidth(text_->width())));
}

void FeelNotice::resizeEvent(QResizeEvent* event) {
  QFrame::resizeEvent(event);
  keepTextWhole();
}

bool FeelNotice::hasWaitedLong(const ServoSnapshot& snapshot) {
  if (!snapshot.isWaiting) waitingSince_ = -1.0;
  if (snapshot.isWaiting && waitingSince_ < 0.0) waitingSince_ = snapshot.time;
  return snapshot.isWaiting && snapshot.time - waitingSince_ > kLongWait;
}

QString FeelNotice::textFor(const ServoSnapshot& snapshot, const Scene& scene) const {
  if (snapshot.fault != ServoFault::None)
    return tr("Nothing is felt: %1.").arg(QString::fromUtf8(faultReason(snapshot.fault)));
  QStringList lines;
  if (snapshot.areJointsContradictory)
    lines << tr("Its joints contradict each other, so that none holds it. Turn one of them off.");
  if (snapshot.overlappingCount > 0) lines << overlapText(snapshot, scene);
  return lines.join(QChar('\n'));
}

QString FeelNotice::overlapText(const ServoSnapshot& snapshot, const Scene& scene) {
  const QString names = namesOf(snapshot, scene);
  if (snapshot.mode == HapticMode::Springs)
    return tr("Overlaps %1. Springs do not keep parts apart.").arg(names);
  if (snapshot.overlappingCount == 1)
    return tr("Overlaps %1, which is not felt until the two are apart.").arg(names);
  return scene.movingGroup()
             ? tr("Overlaps %1, which are not felt until they are apart from the group.").arg(names)
             : tr("Overlaps %1, which are not felt until they are apart from it.").arg(names);
}

}  // namespace nearfit::ui
