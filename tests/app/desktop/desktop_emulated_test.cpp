#include <QFile>
#include <QProcess>
#include <algorithm>
#include <cmath>

#include "core/scene/scene_file.h"
#include "device/interface/device_supervisor.h"
#include "tests/app/cli/place_fixture.h"
#include "tests/app/desktop/desktop_driver.h"
#include "tests/support/eventually.h"
#include "tests/support/places.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

struct EmulatedOutcome {
  int code = -1;
  QString out, err;
};

/// A cube of 20 mm over a fixed one of 40 mm, felt by linear springs: 50 N/m within 0.1 m.
class EmulatedBench {
 public:
  static constexpr double kGap = 0.05, kCutoff = 0.1, kStiffness = 50.0;

  EmulatedBench() {
    writeOff(folder_.path() / "fixed.off", boxMesh(glm::dvec3(0.04)));
    writeOff(folder_.path() / "moving.off", boxMesh(glm::dvec3(0.02)));
  }
  QString file(const char* name) const { return QString::fromStdString((folder_.path() / name).string()); }
  void writeScene(bool isTaken) const {
    std::vector<std::string> arguments = {"scene",
                                          "new",
                                          "fit.nearfit",
                                          "--unit",
                                          "mm",
                                          "--part",
                                          "Fixed=fixed.off",
                                          "--part",
                                          "Moving=moving.off@0,0,0.08,1,0,0,0",
                                          "--cutoff",
                                          "0.1",
                                          "--stiffness",
                                          "50",
                                          "--mode",
                                          "spring"};
    if (isTaken) arguments.insert(arguments.end(), {"--moving", "Moving"});
    ProcessOptions options;
    options.workingFolder = folder_.path();
    const ProcessResult made = runCli(arguments, options);
    QVERIFY2(made.exitCode == 0, made.err.c_str());
  }
  /// nearfit, unchanged, as if what nearfit-emulate makes were plugged in.
  EmulatedOutcome run(const QStringList& emulation, const QStringList& arguments) const {
    QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
    environment.insert(QStringLiteral("XDG_CONFIG_HOME"), file("config"));
    QProcess process;
    process.setProcessEnvironment(environment);
    process.setWorkingDirectory(QString::fromStdString(folder_.path().string()));
    QStringList all = emulation;
    all << QStringLiteral("--") << QString::fromStdString(test::builtPath("nearfit"))
        << QStringLiteral("fit.nearfit") << arguments;
    process.start(QString::fromStdString(test::builtPath("nearfit-emulate")), all);
    if (!process.waitForFinished(120'000)) return {};
    const int code = process.exitStatus() == QProcess::NormalExit ? process.exitCode() : -1;
    return {code, QString::fromLocal8Bit(process.readAllStandardOutput()),
            QString::fromLocal8Bit(process.readAllStandardError())};
  }
  /// A machine on which a thread does not run for 20 ms stops an armed device, and is right to: then, and
  /// then only, again.
  EmulatedOutcome runUnstopped(const QStringList& emulation, const QStringList& arguments) const {
    EmulatedOutcome outcome;
    eventually([&] {
      outcome = run(emulation, arguments);
      return outcome.code == 0 || !wasStoppedForSilence(outcome);
    });
    return outcome;
  }

 private:
  /// By this side, or by the device, for which no wrench came.
  static bool wasStoppedForSilence(const EmulatedOutcome& outcome) {
    const auto isTold = [&](DeviceFault fault) {
      return (outcome.out + outcome.err).contains(QLatin1String(faultReason(fault)), Qt::CaseInsensitive);
    };
    return isTold(DeviceFault::Silent) || isTold(DeviceFault::Reported);
  }

  TemporaryFolder folder_;
};

const QString kOpenHap = QStringLiteral("openhap"), kDevice = QStringLiteral("--device"),
              kSeconds = QStringLiteral("--seconds"), kRecord = QStringLiteral("--record"),
              kFelt = QStringLiteral("felt.csv");

}  // namespace

/// The window, from a device's report to its wrench.
class DesktopEmulatedTest : public QObject {
  Q_OBJECT

 private slots:
  void posesComeInWrenchesGoOutAndAllIsRecorded();
  void withoutArmingNoForceGoesOut();
  void aRecordedHandEndsWithItsRecording();
  void aPulledPlugEndsItWithAReasonAndAWholeRecording();
  void aDeviceThatWasStoppedEndsItWithTheReason();
  void aSceneWithNothingInHandIsTold();
};

void DesktopEmulatedTest::posesComeInWrenchesGoOutAndAllIsRecorded() {
  const EmulatedBench bench;
  bench.writeScene(true);
  const EmulatedOutcome outcome = bench.runUnstopped(
      {kOpenHap},
      {kDevice, kOpenHap, QStringLiteral("--arm"), kSeconds, QStringLiteral("3"), kRecord, kFelt});
  QVERIFY2(outcome.code == 0, qPrintable(outcome.err));
  for (const char* what : {"armed       yes\n", "round trip  p50 ", ", p99 ", ", p99.9 ", ", max "})
    QVERIFY2(outcome.out.contains(QLatin1String(what)), qPrintable(outcome.out));
  qInfo().noquote() << outcome.out << outcome.err;
  const Record record(bench.file("felt.csv").toStdString());
  QVERIFY(record.rows() > 10);
  QVERIFY(std::abs(record["handle_tz"][0] - 0.08) < 1e-3);
  double farthest = 0.0, strongest = 0.0;
  for (std::size_t i = 0; i < record.rows(); ++i) {
    farthest = std::max(farthest, std::abs(record["handle_tx"][i]));
    strongest = std::max(strongest, record["force_z"][i]);
    // The springs' at the least gap that there can be, as the hand goes 4 cm at most.
    QVERIFY(record["force_z"][i] <=
            EmulatedBench::kStiffness * (EmulatedBench::kCutoff - (EmulatedBench::kGap - 0.04)));
  }
  QVERIFY(farthest > 0.005 && farthest <= 0.04 + 1e-6);
  QVERIFY(strongest > 0.5);
}

void DesktopEmulatedTest::withoutArmingNoForceGoesOut() {
  const EmulatedBench bench;
  bench.writeScene(true);
  const EmulatedOutcome outcome =
      bench.run({kOpenHap}, {kDevice, kSeconds, QStringLiteral("1"), kRecord, kFelt});
  QVERIFY2(outcome.code == 0, qPrintable(outcome.err));
  QVERIFY(outcome.out.contains(QStringLiteral("armed       no\n")));
  const Record record(bench.file("felt.csv").toStdString());
  for (const double force : record["force_z"])
    QCOMPARE(force, 0.0);
}

void DesktopEmulatedTest::aRecordedHandEndsWithItsRecording() {
  const EmulatedBench bench;
  bench.writeScene(true);
  const EmulatedOutcome made =
      bench.run({kOpenHap}, {kDevice, kSeconds, QStringLiteral("1"), kRecord, kFelt});
  QVERIFY2(made.code == 0, qPrintable(made.err));
  const EmulatedOutcome again =
      bench.run({kOpenHap}, {kDevice, QStringLiteral("replay:felt.csv"), kSeconds, QStringLiteral("100"),
                             kRecord, QStringLiteral("again.csv")});
  QVERIFY2(again.code == 0, qPrintable(again.err));
  const Record before(bench.file("felt.csv").toStdString()), after(bench.file("again.csv").toStdString());
  for (const char* column : {"handle_tx", "handle_ty", "handle_tz"}) {
    QVERIFY(std::abs(after[column].front() - before[column].front()) < 1e-9);
    QVERIFY(std::abs(after[column].back() - before[column].back()) < 1e-9);
  }
}

void DesktopEmulatedTest::aPulledPlugEndsItWithAReasonAndAWholeRecording() {
  const EmulatedBench bench;
  bench.writeScene(true);
  // On a busy machine the window may not be there yet when the plug is pulled: then later.
  EmulatedOutcome outcome;
  for (const char* later : {"5", "20", "60"}) {
    outcome = bench.run({kOpenHap, kSeconds, QLatin1String(later)},
                        {kDevice, kSeconds, QStringLiteral("100"), kRecord, kFelt});
    if (QFile::exists(bench.file("felt.csv")) && Record(bench.file("felt.csv").toStdString()).rows() > 0)
      break;
  }
  QCOMPARE(outcome.code, 1);
  QVERIFY2(outcome.err.contains(QStringLiteral("nearfit: ")), qPrintable(outcome.err));
  QVERIFY2(outcome.err.contains(QStringLiteral("lost")), qPrintable(outcome.err));
  QVERIFY(Record(bench.file("felt.csv").toStdString()).rows() > 0);
}

// It was waited for without end: that it had been stopped was found once it had ended.
void DesktopEmulatedTest::aDeviceThatWasStoppedEndsItWithTheReason() {
  const EmulatedBench bench;
  bench.writeScene(true);
  // To and fro by 8 mm a report, which is 8 m/s: no hand is so fast.
  QFile path(bench.file("leaps.csv"));
  QVERIFY(path.open(QIODevice::WriteOnly));
  path.write("0,0,0,1,0,0,0\n0.008,0,0,1,0,0,0\n");
  path.close();
  const EmulatedOutcome outcome =
      bench.run({kOpenHap, QStringLiteral("--path"), bench.file("leaps.csv")},
                {kDevice, kOpenHap, QStringLiteral("--arm"), kSeconds, QStringLiteral("2"), kRecord, kFelt});
  QCOMPARE(outcome.code, 1);
  QVERIFY2(outcome.err.contains(QStringLiteral("nearfit: Stopped: ")), qPrintable(outcome.err));
  QVERIFY(QFile::exists(bench.file("felt.csv")));
}

void DesktopEmulatedTest::aSceneWithNothingInHandIsTold() {
  const EmulatedBench bench;
  bench.writeScene(false);
  const EmulatedOutcome outcome = bench.run({kOpenHap}, {kDevice, kSeconds, QStringLiteral("1")});
  QCOMPARE(outcome.code, 1);
  QVERIFY2(outcome.err.contains(QStringLiteral("no part of the scene is in hand")), qPrintable(outcome.err));
}

NEARFIT_QT_SUITE(DesktopEmulatedTest, runDesktopTest<DesktopEmulatedTest>)
#include "desktop_emulated_test.moc"
