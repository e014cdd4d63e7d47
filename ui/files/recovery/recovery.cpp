#include "ui/files/recovery/recovery.h"

#include <QCoreApplication>
#include <QDateTime>
#include <QDialogButtonBox>
#include <QFrame>
#include <QLabel>
#include <QLocale>
#include <QPushButton>
#include <QScrollArea>
#include <QTimer>
#include <QVBoxLayout>
#include <iterator>
#include <utility>

#include "ui/files/document.h"
#include "ui/model/hand_state.h"
#include "ui/widgets/font_scale.h"
#include "ui/widgets/format.h"
#include "ui/widgets/names.h"
#include "ui/widgets/paths.h"

namespace nearfit::ui {
namespace {

constexpr int kWidth = 560, kMaxHeight = 420;

QString timeText(std::chrono::system_clock::time_point time) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch()).count();
  const QDateTime local = QDateTime::fromSecsSinceEpoch(seconds);
  if (local.date() == QDate::currentDate())
    return QObject::tr("today %1").arg(QLocale().toString(local.time(), QLocale::ShortFormat));
  return QLocale().toString(local, QLocale::ShortFormat);
}

QString lostWorkName(const LostWork& work) {
  return work.head.scene.empty() ? QObject::tr("Untitled scene, never saved")
                                 : fromPath(work.head.scene.filename());
}

QString changesText(std::size_t count) {
  return count == 1 ? QObject::tr("1 unsaved change")
                    : QObject::tr("%n unsaved changes", nullptr, static_cast<int>(count));
}

QLabel* plainLabel(const QString& text, QWidget* parent) {
  auto* label = new QLabel(breakable(text), parent);
  label->setTextFormat(Qt::PlainText);
  label->setWordWrap(true);
  return label;
}

Autosave::PoseInHand poseIn(const HandState& hand) {
  const std::optional<PartId> part = hand.part();
  if (!part) return std::nullopt;
  return std::pair(*part, hand.partPose());
}

}  // namespace

RecoveryDialog::RecoveryDialog(const std::vector<LostWork>& lost, QWidget* parent)
    : QDialog(parent), rows_(new QVBoxLayout) {
  setObjectName(QStringLiteral("recoveryDialog"));
  setWindowTitle(tr("Recover unsaved work"));
  setAttribute(Qt::WA_DeleteOnClose);
  setWindowModality(Qt::WindowModal);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(plainLabel(tr("Nearfit ended before this work was saved. Items left for later are "
                                  "offered at next start."),
                               this));
  auto* list = new QWidget(this);
  list->setLayout(rows_);
  rows_->setContentsMargins(0, 0, 0, 0);
  for (const LostWork& work : lost)
    addRow(work, rowCount_ + 1);
  rows_->addStretch();
  auto* area = new QScrollArea(this);
  area->setFrameShape(QFrame::NoFrame);
  area->setWidgetResizable(true);
  area->setFocusPolicy(Qt::NoFocus);
  area->setWidget(list);
  area->setMinimumHeight(std::min(list->sizeHint().height() + 4, forFont(*this, kMaxHeight)));
  layout->addWidget(area);
  auto* buttons = new QDialogButtonBox(this);
  QPushButton* later = buttons->addButton(tr("Later for all"), QDialogButtonBox::RejectRole);
  later->setObjectName(QStringLiteral("allLater"));
  later->setAutoDefault(false);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  layout->addWidget(buttons);
  setMinimumWidth(forFont(*this, kWidth));
}

void RecoveryDialog::addRow(const LostWork& work, int number) {
  auto* row = new QFrame(this);
  row->setObjectName(QStringLiteral("lost%1").arg(number));
  row->setFrameShape(QFrame::StyledPanel);
  auto* layout = new QVBoxLayout(row);
  QLabel* name = plainLabel(lostWorkName(work), row);
  QFont bold = name->font();
  bold.setBold(true);
  name->setFont(bold);
  layout->addWidget(name);
  if (!work.head.scene.empty()) layout->addWidget(plainLabel(fromPath(work.head.scene), row));
  layout->addWidget(
      plainLabel(tr("Last change %1, %2, %3")
                     .arg(timeText(work.time), changesText(work.head.changes), formatParts(work.head.parts)),
                 row));
  auto* buttons = new QDialogButtonBox(row);
  const auto addButton = [&](const QString& text, const char* objectName, QDialogButtonBox::ButtonRole role) {
    QPushButton* button = buttons->addButton(text, role);
    button->setObjectName(QLatin1String(objectName) + QString::number(number));
    button->setAccessibleName(tr("%1: %2").arg(text, lostWorkName(work)));
    button->setAutoDefault(false);
    return button;
  };
  QPushButton* restore = addButton(tr("Restore"), "restore", QDialogButtonBox::ActionRole);
  restore->setToolTip(tr("Open the scene as it was; you still have to save it"));
  restore->setDefault(number == 1);
  QPushButton* discard = addButton(tr("Discard"), "discard", QDialogButtonBox::ActionRole);
  discard->setToolTip(tr("Do not offer this work again"));
  QPushButton* later = addButton(tr("Later"), "later", QDialogButtonBox::ActionRole);
  later->setToolTip(tr("Offer this work again at the next start"));
  connect(restore, &QPushButton::clicked, this, [this, work] {
    accept();
    emit restoreRequested(work);
  });
  connect(discard, &QPushButton::clicked, this, [this, work, row] {
    emit discardRequested(work);
    removeRow(row);
  });
  connect(later, &QPushButton::clicked, this, [this, row] { removeRow(row); });
  layout->addWidget(buttons);
  rows_->addWidget(row);
  ++rowCount_;
}

void RecoveryDialog::removeRow(QWidget* row) {
  row->hide();
  row->deleteLater();
  if (--rowCount_ == 0) accept();
}

Recovery::Recovery(const std::filesystem::path& folder, Session& session, Document& document,
                   const HandState& hand, QWidget* window)
    : QObject(window),
      folder_(std::make_shared<RecoveryFolder>(folder)),
      document_(document),
      window_(window),
      autosave_(new Autosave(session, folder_, [&hand] { return poseIn(hand); }, this)) {
  connect(&hand, &HandState::snapshotShown, autosave_, &Autosave::noteMotion);
  connect(autosave_, &Autosave::failed, this, [this](const QString& cause) {
    emit noted(tr("Unsaved work cannot be protected against a crash: %1").arg(cause));
  });
  connect(qApp, &QCoreApplication::aboutToQuit, autosave_, &Autosave::finish);
}

void Recovery::offer() {
  look(0);
}

void Recovery::look(int number) {
  if (search_.isRunning()) return;
  static constexpr int kLater[] = {kSecondLookMs, kThirdLookMs - kSecondLookMs};
  auto found = std::make_shared<FoundWork>();
  search_.run([found, folder = folder_](const ProgressCallback&) { *found = folder->takeLost(); },
              [this, found, number](const std::exception_ptr&) {
                if (found->areOthersRunning && number < static_cast<int>(std::size(kLater)))
                  QTimer::singleShot(kLater[number], this, [this, number] { look(number + 1); });
                show(*found);
                emit looked();
              });
}

void Recovery::show(const FoundWork& found) {
  if (!found.damaged.empty()) {
    QStringList files;
    for (const std::filesystem::path& file : found.damaged)
      files << fromPath(file);
    emit failed({tr("Unsaved work of an earlier run could not be recovered: its journal is damaged."),
                 tr("The scene is as it was last saved. The journal is kept as\n%1").arg(files.join('\n'))});
  }
  if (found.lost.empty()) return;
  auto* dialog = new RecoveryDialog(found.lost, window_);
  connect(dialog, &RecoveryDialog::restoreRequested, this, &Recovery::restore);
  connect(dialog, &RecoveryDialog::discardRequested, this,
          [folder = folder_](const LostWork& work) { folder->discard(work); });
  dialog->open();
}

void Recovery::restore(const LostWork& work) {
  if (document_.isBusy()) {
    // Files from the command line are still being opened.
    auto* once = new QObject(this);
    connect(
        &document_, &Document::busyChanged, once,
        [this, once, work] {
          if (document_.isBusy()) return;
          once->deleteLater();
          restore(work);
        },
        Qt::QueuedConnection);
    return;
  }
  document_.openRecovered(fromPath(work.journal), work.head.scene, [this, work] {
    // The old journal goes only when the new one holds its work.
    auto* once = new QObject(this);
    connect(autosave_, &Autosave::written, once, [once, work, folder = folder_] {
      folder->forget(work);
      once->deleteLater();
    });
    autosave_->writeNow();
    emit noted(tr("Restored; save the scene to keep it"));
  });
}

}  // namespace nearfit::ui
