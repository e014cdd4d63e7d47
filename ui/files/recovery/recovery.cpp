#include "ui/files/recovery/recovery.h"

#include <QCoreApplication>
#include <QTimer>
#include <iterator>
#include <utility>

#include "ui/files/document.h"
#include "ui/files/recovery/recovery_dialog.h"
#include "ui/model/hand_state.h"
#include "ui/widgets/paths.h"

namespace nearfit::ui {
namespace {

Autosave::PoseInHand poseIn(const HandState& hand) {
  const std::optional<PartId> part = hand.part();
  if (!part) return std::nullopt;
  return std::pair(*part, hand.partPose());
}

}  // namespace

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
