#include "app/desktop/screenshot.h"

#include <QCoreApplication>
#include <QImage>
#include <QPixmap>
#include <QTimer>
#include <cstdio>
#include <utility>

#include "core/base/error.h"
#include "ui/files/document.h"
#include "ui/panels/feel/feel_control.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/picture_file.h"

namespace nearfit::desktop {
namespace {

constexpr int kSettleMs = 400;  ///< Time for layout and the first pictures.
/// The scripted hand presses and turns then; in ticks, so that each picture shows the same pose.
constexpr std::uint64_t kFeelFor = 2450;
constexpr int kPatienceMs = 20'000;  ///< The picture is written then even if no servo ever ticked.

}  // namespace

Screenshot::Screenshot(Application& application, QString output)
    : application_(application), output_(std::move(output)) {
  ui::MainWindow& window = application_.window();
  window.setFailureSink(
      [this](const ui::Failure& failure) { fail(failure.summary + QChar('\n') + failure.details); });
  connect(&window.document(), &ui::Document::noted, this, [this](const QString& note) { note_ = note; });
  connect(&window.document(), &ui::Document::loaded, this, &Screenshot::arrange);
}

void Screenshot::take(const QStringList& files, std::optional<double> metresPerUnit,
                      const std::optional<Tessellation>& tessellation) {
  ui::MainWindow& window = application_.window();
  window.resize(1280, 800);
  window.show();
  if (files.isEmpty()) {
    QTimer::singleShot(kSettleMs, this, &Screenshot::write);
  } else {
    QTimer::singleShot(0, this, [=, this] {
      application_.window().document().openFiles(files, metresPerUnit, tessellation);
    });
  }
}

void Screenshot::arrange(bool isComplete) {
  if (!isComplete) {
    fail(note_.isEmpty() ? tr("the files could not be opened") : note_);
    return;
  }
  if (!application_.session().scene().movingPart()) {
    QTimer::singleShot(kSettleMs, this, &Screenshot::write);
    return;
  }
  application_.window().viewport().fitParts(application_.session().scene().movingParts());
  connect(&application_.servo(), &ServoController::snapshotArrived, this, &Screenshot::waitForMinima);
  QTimer::singleShot(kPatienceMs, this, &Screenshot::write);
  application_.window().document().prepareHierarchies([this](bool isReady) {
    if (!isReady) return;
    application_.window().feel().chooseScriptedHand();
    application_.servo().start(ui::Hand::Scripted);
  });
}

void Screenshot::waitForMinima(const ServoSnapshot& snapshot) {
  if (snapshot.tick < kFeelFor) return;
  disconnect(&application_.servo(), &ServoController::snapshotArrived, this, nullptr);
  // Once the figures of this very snapshot are in the view.
  QTimer::singleShot(0, this, &Screenshot::write);
}

void Screenshot::write() {
  if (std::exchange(isWriting_, true) || hasFailed_) return;
  application_.window().viewport().completePicture();
  try {
    ui::writePicture(application_.window().grab().toImage(), output_);
  } catch (const Error& error) {
    fail(QString::fromStdString(error.what()));
    return;
  }
  QCoreApplication::exit(0);
}

void Screenshot::fail(const QString& message) {
  if (!hasFailed_) std::fprintf(stderr, "nearfit: %s\n", message.simplified().toLocal8Bit().constData());
  hasFailed_ = true;
  QCoreApplication::exit(1);
}

}  // namespace nearfit::desktop
