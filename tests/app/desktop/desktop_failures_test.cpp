#include <QDialog>
#include <QDockWidget>
#include <QStatusBar>
#include <QTableWidget>

#include "core/servo/motion_reader.h"
#include "tests/app/desktop/desktop_driver.h"
#include "tests/support/file_size_limit.h"

using namespace nearfit;
using namespace nearfit::test;

namespace fs = std::filesystem;

namespace {

/// Some half a second of a recording.
constexpr rlim_t kDiskSpace = 200'000;

/// The scripted hand leads the part, and all that is felt is recorded to a disk that gets full.
struct Full {
  Full() {
    d.addCubes();
    d.chooseHand(ui::Hand::Scripted);
    QObject::connect(&d.application.servo(), &desktop::ServoController::snapshotArrived, &d.application,
                     [this](const ServoSnapshot&) { ++pictures; });
  }
  /// To a file that is not there yet: else it would be asked.
  void record() {
    ++recordings;
    whenModal<QFileDialog>([this](QFileDialog* dialog) { chooseFile(dialog, name()); });
    QApplication::setActiveWindow(&d.window());
    pressShortcut(d, Qt::Key_F8);
    QVERIFY(d.action("record")->isChecked());
  }
  void feel() {
    QApplication::setActiveWindow(&d.window());
    pressShortcut(d, Qt::Key_F5);
    QTRY_VERIFY(d.application.servo().isRunning());
  }
  fs::path file() const { return d.folder.path() / ("felt" + std::to_string(recordings) + ".csv"); }
  QString name() const { return QString::fromStdString(file().string()); }
  QDialog* box() { return d.widget<QDialog>("errorBox"); }

  DesktopDriver d;
  int pictures = 0, recordings = 0;
};

}  // namespace

class DesktopFailuresTest : public QObject {
  Q_OBJECT

 private slots:
  void whatFailsWhileItRunsStopsNothingAndTheServoCanBeStopped();
  void aRecordingThatFailsKeepsWhatWasFeltUntilThen();
  void aRecordingThatIsCutIsPlayedAndSaysSo();
  void laterFailuresJoinTheBoxThatIsOpen();
};

void DesktopFailuresTest::whatFailsWhileItRunsStopsNothingAndTheServoCanBeStopped() {
  Full f;
  f.record();
  const FileSizeLimit full(kDiskSpace);
  f.feel();
  QTRY_VERIFY(f.box() != nullptr);
  QVERIFY(f.box()->isVisible());
  QVERIFY(QApplication::activeModalWidget() == nullptr);
  const int before = f.pictures;
  QTRY_VERIFY2(f.pictures > before + 10, "what is felt is shown on");
  QVERIFY(f.d.application.servo().isRunning());
  QVERIFY(f.box() != nullptr);

  QApplication::setActiveWindow(f.box());
  QTest::keyClick(f.box(), Qt::Key_F6);
  QTRY_VERIFY(!f.d.application.servo().isRunning());
  QVERIFY2(f.box() != nullptr, "it waits to be read");
  QTest::keyClick(f.box(), Qt::Key_Escape);
  QTRY_VERIFY(f.box() == nullptr);
}

void DesktopFailuresTest::aRecordingThatFailsKeepsWhatWasFeltUntilThen() {
  Full f;
  f.record();
  {
    const FileSizeLimit full(kDiskSpace);
    f.feel();
    QTRY_VERIFY(f.box() != nullptr);
  }
  const Recording kept = readRecording(f.file());
  QVERIFY(!kept.isCut);
  QVERIFY(kept.rows.size() > 100);
  const QString summary = f.d.text("errorSummary"), status = f.d.window().statusBar()->currentMessage();
  const QString seconds = QString::number(kept.rows.back().time, 'f', 1);
  QVERIFY2(summary.contains(QStringLiteral("after %1 s").arg(seconds)), qPrintable(summary));
  QVERIFY2(summary.contains(QStringLiteral("felt1.csv")), qPrintable(summary));
  QVERIFY2(f.d.text("errorDetails").contains(QStringLiteral("too large")), "why");
  QVERIFY(!f.d.action("record")->isChecked());
  QVERIFY2(!status.contains(QStringLiteral("will be recorded")), qPrintable(status));
  keepPictures(f.d.window(), QStringLiteral("recording-failed"));
  // It goes on being felt, and can be recorded again.
  f.record();
  const int pictures = f.pictures;
  QTRY_VERIFY(f.pictures > pictures + 10);
  pressShortcut(f.d, Qt::Key_F6);
  QTRY_VERIFY(!f.d.application.servo().isRunning());
  QVERIFY(!readRecording(f.file()).isCut);
  QCOMPARE(readRecording(f.d.folder.path() / "felt1.csv").rows.size(), kept.rows.size());
}

void DesktopFailuresTest::aRecordingThatIsCutIsPlayedAndSaysSo() {
  Full f;
  f.record();
  f.feel();
  QTRY_VERIFY(f.pictures > 10);
  pressShortcut(f.d, Qt::Key_F6);
  QTRY_VERIFY(!f.d.application.servo().isRunning());
  const double whole = readMotion(f.file()).back().time;
  fs::resize_file(f.file(), fs::file_size(f.file()) - 100);
  whenModal<QFileDialog>([&f](QFileDialog* dialog) { chooseFile(dialog, f.name()); });
  pressShortcut(f.d, Qt::Key_F8, Qt::ShiftModifier);
  QTRY_VERIFY(f.d.widget<QDockWidget>("timelineDock")->isVisible());
  const QString status = f.d.window().statusBar()->currentMessage();
  QVERIFY2(status.contains(QStringLiteral("incomplete")), qPrintable(status));
  const Recording read = readRecording(f.file());
  QVERIFY(read.isCut);
  QVERIFY(read.rows.back().time < whole);
}

void DesktopFailuresTest::laterFailuresJoinTheBoxThatIsOpen() {
  Full f;
  f.record();
  const FileSizeLimit full(kDiskSpace);
  f.feel();
  QTRY_VERIFY(f.box() != nullptr);
  const QString first = f.d.text("errorSummary");
  f.record();
  QTRY_VERIFY2(f.d.text("errorSummary").contains(QStringLiteral("2")), "failed again");
  for (int i = 0; i < 50; ++i)
    f.d.window().showFailure({QStringLiteral("The scene could not be saved."),
                              QStringLiteral("No space is left.\n\nFree some."),
                              {}});
  QCOMPARE(f.d.window().findChildren<QDialog*>(QStringLiteral("errorBox")).size(), 1);
  auto* table = f.d.widget<QTableWidget>("errorTable");
  const int last = table->rowCount() - 1;
  QVERIFY(last >= 1);
  QVERIFY(table->isVisible());
  QVERIFY(table->item(0, 0)->text().startsWith(first.left(20)));
  QCOMPARE(table->item(last, 0)->text(), QStringLiteral("The scene could not be saved. (50 times)"));
  QCOMPARE(table->item(last, 1)->text(), QStringLiteral("No space is left."));
  QCOMPARE(table->item(last, 2)->text(), QStringLiteral("Free some."));
  QTRY_VERIFY2(f.box()->width() >= table->minimumWidth(), "nothing is cut off");
  keepPictures(*f.box(), QStringLiteral("joined-failures"));
  QTest::mouseClick(f.box()->findChild<QPushButton*>(), Qt::LeftButton);
}

NEARFIT_QT_SUITE(DesktopFailuresTest, runDesktopTest<DesktopFailuresTest>)
#include "desktop_failures_test.moc"
