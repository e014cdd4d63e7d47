#include <QComboBox>
#include <cmath>

#include "core/servo/motion_recording.h"
#include "tests/app/desktop/desktop_driver.h"
#include "ui/panels/feel/feel_control.h"
#include "ui/widgets/error_box.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// The application with two cubes, and a recorded hand that goes 3 mm along x, far from either.
struct ReplayFixture {
  ReplayFixture() {
    d.window().setFailureSink([this](const ui::Failure& failure) { failures << failure; });
    d.addCubes();
    MotionWriter writer(d.folder.path() / "felt.csv");
    constexpr int kRows = 300, kMoving = 150;
    for (int i = 0; i < kRows; ++i) {
      MotionRow row;
      row.time = 1e-3 * i;
      row.handle.translation = {0.5 + 0.003 * std::min(i, kMoving) / kMoving, 0.4, 0.3};
      writer.write(row);
    }
    writer.finish();
  }
  QString file(const char* name) { return QString::fromStdString((d.folder.path() / name).string()); }
  void chooseRecordedHand() {
    auto* box = d.widget<QComboBox>("hand");
    box->setFocus();
    for (int i = 0; i < 2; ++i)
      QTest::keyClick(box, Qt::Key_Down);
    QCOMPARE(box->currentText(), QStringLiteral("Recorded hand"));
  }
  void pressFeel() { QTest::mouseClick(d.widget<QPushButton>("startStop"), Qt::LeftButton); }

  DesktopDriver d;
  QVector<ui::Failure> failures;
};

}  // namespace

class DesktopReplayTest : public QObject {
  Q_OBJECT

 private slots:
  void aRecordedHandIsAskedForLeadsThePartAndPutsItDown();
  void whoWantsNoFileStartsNothing();
  void whatIsNoRecordingIsTold();
  void whatIsFeltIsRecorded();
};

void DesktopReplayTest::aRecordedHandIsAskedForLeadsThePartAndPutsItDown() {
  ReplayFixture f;
  f.chooseRecordedHand();
  QVERIFY(f.d.widget<QPushButton>("chooseRecording")->isVisible());
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, f.file("felt.csv")); });
  f.pressFeel();
  QTRY_COMPARE(QString::fromStdString(f.d.session().undoText()), QStringLiteral("Feel moving"));
  QVERIFY(!f.d.application.servo().status().isTaken());
  const double x = f.d.part("moving").worldFromPart.translation.x;
  QVERIFY2(std::abs(x - 0.003) < 1e-4, qPrintable(QString::number(x)));
  // Known now, it is felt again without being asked for: from where the part is.
  QCOMPARE(f.d.text("deviceState"), QStringLiteral("felt.csv"));
  f.pressFeel();
  QTRY_VERIFY(std::abs(f.d.part("moving").worldFromPart.translation.x - 0.006) < 2e-4);
  QVERIFY(f.failures.isEmpty());
}

void DesktopReplayTest::whoWantsNoFileStartsNothing() {
  ReplayFixture f;
  f.chooseRecordedHand();
  whenModal<QFileDialog>([](QFileDialog* dialog) { dialog->reject(); });
  f.pressFeel();
  QTest::qWait(50);
  QVERIFY(!f.d.application.servo().status().isTaken());
  QVERIFY(f.failures.isEmpty());
}

void DesktopReplayTest::whatIsNoRecordingIsTold() {
  ReplayFixture f;
  f.d.folder.write("path.csv", "0,0,0,1,0,0,0\n");
  f.chooseRecordedHand();
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, f.file("path.csv")); });
  f.pressFeel();
  QTRY_COMPARE(f.failures.size(), 1);
  QVERIFY(f.failures[0].details.contains(QStringLiteral("here is no column t_s")));
  QVERIFY(!f.d.application.servo().status().isTaken());
}

void DesktopReplayTest::whatIsFeltIsRecorded() {
  ReplayFixture f;
  f.d.application.servo().recordTo(f.file("again.csv"));
  f.d.window().feel().feelWith(QStringLiteral("replay:") + f.file("felt.csv"));
  // The file is there once it is whole.
  QTRY_VERIFY(QFile::exists(f.file("again.csv")));
  QTRY_VERIFY(!f.d.application.servo().status().isTaken());
  QFile again(f.file("again.csv"));
  QVERIFY(again.open(QIODevice::ReadOnly));
  const QList<QByteArray> lines = again.readAll().split('\n');
  QCOMPARE(lines.first(), QByteArray(motionHeader().data(), static_cast<int>(motionHeader().size())));
  QVERIFY(lines.size() > 10);
  QVERIFY(f.failures.isEmpty());
}

NEARFIT_QT_SUITE(DesktopReplayTest, runDesktopTest<DesktopReplayTest>)
#include "desktop_replay_test.moc"
