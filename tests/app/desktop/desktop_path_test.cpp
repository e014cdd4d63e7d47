#include <QDockWidget>
#include <QSlider>
#include <QToolButton>
#include <filesystem>

#include "core/files/sha256.h"
#include "core/path/certificate.h"
#include "core/path/path_file.h"
#include "core/path/path_verifier.h"
#include "core/servo/motion_recording.h"
#include "tests/app/desktop/desktop_driver.h"
#include "tests/app/desktop/dialog_answers.h"
#include "ui/model/shown_poses.h"
#include "ui/panels/replay/timeline.h"
#include "ui/widgets/error_box.h"
#include "ui/widgets/number_field.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

RigidTransform placeAt(double x, double z) {
  return {glm::dquat(1, 0, 0, 0), glm::dvec3(x, 0.0, z)};
}

/// The two cubes, 5 mm apart; motions of the upper one, in hand.
struct PathFixture {
  PathFixture() {
    d.window().setFailureSink([this](const ui::Failure& failure) { failures << failure; });
    d.addCubes();
  }
  /// A path of a part from its place to another within a second, from 3 s on.
  std::filesystem::path writePath(const char* part, const RigidTransform& end) {
    AssemblyPath path;
    path.parts = {part};
    path.centre = {0.0, 0.0, 0.035};
    path.poses = {{3.0, placeAt(0.0, 0.0)}, {4.0, end}};
    const auto file = d.folder.path() / "in.nfpath";
    writePathFile(path, file);
    return file;
  }
  /// A recording of two seconds in which the part goes 20 mm along x.
  std::filesystem::path writeRecording() {
    constexpr int kRows = 201;
    const auto file = d.folder.path() / "felt.csv";
    MotionWriter writer(file);
    for (int i = 0; i < kRows; ++i) {
      MotionRow row;
      row.time = 1e-2 * i;
      row.proxy = row.handle = placeAt(1e-4 * i, 0.0);
      writer.write(row);
    }
    writer.finish();
    return file;
  }
  /// Opens it, and stops at its start.
  void open(const std::filesystem::path& file) {
    DialogAnswers answers;
    answers.expectFile(QString::fromStdString(file.string()));
    pressShortcut(d, Qt::Key_F8, Qt::ShiftModifier);
    QTRY_COMPARE(d.text("timelineName"), QString::fromStdString(file.filename().string()));
    QTest::mouseClick(d.widget<QToolButton>("timelinePlay"), Qt::LeftButton);
    auto* scale = d.widget<QSlider>("timelineScale");
    scale->setFocus();
    QTest::keyClick(scale, Qt::Key_Home);
    QTRY_COMPARE(shownTime(), 0.0);
  }
  /// Gives a command that asks with these dialogs.
  void choose(const char* command, DialogAnswers& answers) {
    d.choose(command);
    QVERIFY2(answers.faults().isEmpty(), qPrintable(answers.faults().join(' ')));
  }
  void certify() {
    DialogAnswers answers;
    answers.expectButton(QStringLiteral("certifyDialog"), QDialogButtonBox::Ok);
    choose("certifyPath", answers);
    QTRY_VERIFY(!d.text("timelineResult").isEmpty());
  }
  double shownTime() { return d.text("timelineTime").section(' ', 0, 0).toDouble(); }
  double shownX() { return d.window().viewport().poses().poseOf(d.part("moving")).translation.x; }

  DesktopDriver d;
  QVector<ui::Failure> failures;
};

}  // namespace

class DesktopPathTest : public QObject {
  Q_OBJECT

 private slots:
  void aPathIsPlayedAsARecordingIs();
  void aPathOfAPartThatIsNotInHandIsRefused();
  void withoutAMotionThereIsNothingToChoose();
  void aRecordingIsSavedAsAPathOfTheTimelinesRange();
  void theClearanceAlongAPathIsShown();
  void aFreePathIsCertifiedAndTheCertificateIsProvenAnew();
  void aCertificateOfASavedSceneNamesItsFile();
  void theSeparationsOfferedAreRoundedDown_data();
  void theSeparationsOfferedAreRoundedDown();
  void whatIsNotProvenIsShownWhereItIs();
  void aProofEndsWithTheSceneItIsOf();
  void posesClearancesAnimationAndSweptVolumeAreExported();
};

void DesktopPathTest::aPathIsPlayedAsARecordingIs() {
  PathFixture f;
  f.open(f.writePath("moving", placeAt(0.03, 0.0)));
  QCOMPARE(f.shownX(), 0.0);
  QTest::keyClick(f.d.widget<QSlider>("timelineScale"), Qt::Key_End);
  QTRY_COMPARE(f.shownTime(), 1.0);
  QVERIFY(isNear(f.shownX(), 0.03, 1e-12));
  QTest::mouseClick(f.d.widget<QToolButton>("timelineClose"), Qt::LeftButton);
  QCOMPARE(f.shownX(), 0.0);
  QVERIFY(f.failures.isEmpty());
}

void DesktopPathTest::aPathOfAPartThatIsNotInHandIsRefused() {
  PathFixture f;
  const QString file = QString::fromStdString(f.writePath("fixed", placeAt(0.03, 0.0)).string());
  DialogAnswers answers;
  answers.expectFile(file);
  pressShortcut(f.d, Qt::Key_F8, Qt::ShiftModifier);
  QTRY_COMPARE(f.failures.size(), 1);
  QVERIFY2(f.failures.first().details.contains(QStringLiteral("Take it in hand")),
           qPrintable(f.failures.first().details));
  QCOMPARE(f.d.text("timelineName"), QStringLiteral("No recording is open."));
}

void DesktopPathTest::withoutAMotionThereIsNothingToChoose() {
  PathFixture f;
  for (const char* name : {"savePath", "plotPathClearance", "certifyPath", "saveCertificate", "exportSwept"})
    QVERIFY2(!f.d.action(name)->isEnabled(), name);
  f.open(f.writeRecording());
  QVERIFY(f.d.action("savePath")->isEnabled() && f.d.action("certifyPath")->isEnabled());
  QVERIFY2(!f.d.action("plotPathClearance")->isEnabled(), "a recording has its distances");
  QVERIFY(!f.d.action("saveCertificate")->isEnabled());
}

void DesktopPathTest::aRecordingIsSavedAsAPathOfTheTimelinesRange() {
  PathFixture f;
  f.open(f.writeRecording());
  auto* timeline = f.d.widget<ui::Timeline>("timelinePanel");
  QTest::keyClick(timeline, Qt::Key_Right, Qt::ShiftModifier);
  QTRY_COMPARE(f.shownTime(), 1.0);
  QTest::keyClick(timeline, Qt::Key_BracketLeft);
  QCOMPARE(timeline->range(), std::pair(1.0, 2.0));
  const auto file = f.d.folder.path() / "saved.nfpath";
  DialogAnswers answers;
  answers.expectButton(QStringLiteral("pathDialog"), QDialogButtonBox::Ok)
      .expectFile(QString::fromStdString(file.string()));
  f.choose("savePath", answers);
  QTRY_VERIFY(std::filesystem::exists(file));
  const AssemblyPath path = readPathFile(file);
  QCOMPARE(path.parts, std::vector<std::string>{"moving"});
  // It is straight: thinning leaves its ends.
  QCOMPARE(path.poses.size(), std::size_t{2});
  QCOMPARE(path.poses.front().time, 1.0);
  QCOMPARE(path.poses.back().time, 2.0);
  QVERIFY(isNear(path.poses.front().worldFromLead.translation.x, 0.01, 1e-9));
  // The file is there before the commands are free again.
  QTRY_VERIFY(f.d.action("pathWhole")->isEnabled());
  f.d.choose("pathWhole");
  QCOMPARE(timeline->range(), std::pair(0.0, 2.0));
}

void DesktopPathTest::theClearanceAlongAPathIsShown() {
  PathFixture f;
  f.open(f.writePath("moving", placeAt(0.0, 0.0005)));
  QVERIFY2(f.d.text("timelineNote").contains(QStringLiteral("Clearance –")),
           qPrintable(f.d.text("timelineNote")));
  f.d.choose("plotPathClearance");
  const auto shows = [&](const char* length) {
    return f.d.text("timelineNote").contains(QStringLiteral("Clearance ") + QLatin1String(length));
  };
  QTRY_VERIFY2(shows("5.00 mm"), qPrintable(f.d.text("timelineNote")));
  // It goes up by half a millimetre.
  auto* scale = f.d.widget<QSlider>("timelineScale");
  scale->setFocus();
  QTest::keyClick(scale, Qt::Key_End);
  QTRY_VERIFY2(shows("5.50 mm"), qPrintable(f.d.text("timelineNote")));
}

void DesktopPathTest::aFreePathIsCertifiedAndTheCertificateIsProvenAnew() {
  PathFixture f;
  f.open(f.writePath("moving", placeAt(0.03, 0.0)));
  f.certify();
  QVERIFY2(f.d.text("timelineResult").startsWith(QStringLiteral("Certified: from 0.000 s to 1.000 s")),
           qPrintable(f.d.text("timelineResult")));
  // As the dialog offers it; it was said to be 0.034 µm.
  QVERIFY2(f.d.text("timelineResult").contains(QStringLiteral("keeps 0.000034 mm from")),
           qPrintable(f.d.text("timelineResult")));
  keepPictures(f.d.window(), QStringLiteral("path-certified"));
  const auto file = f.d.folder.path() / "in.nfcert";
  DialogAnswers answers;
  answers.expectFile(QString::fromStdString(file.string()));
  f.choose("saveCertificate", answers);
  QTRY_VERIFY(std::filesystem::exists(file));
  const Certificate certificate = parseCertificate(readBytes(file), file);
  QVERIFY2(certificate.sceneSha256.empty(), "the scene was not saved");
  const Verification verified = verifyCertificate(certificate, f.d.session().scene(), {}, std::nullopt);
  QVERIFY2(verified.isProven(), verified.problem.c_str());
  QCOMPARE(certificate.sceneFile, std::string());
  QCOMPARE(certificate.pathFile, std::string("in.nfpath"));
  QCOMPARE(certificate.pathFileSha256, sha256OfFile(f.d.folder.path() / "in.nfpath"));
}

void DesktopPathTest::aCertificateOfASavedSceneNamesItsFile() {
  PathFixture f;
  f.d.session().save(f.d.folder.path() / "cubes.nearfit");
  const auto save = [&f](const std::filesystem::path& file) {
    f.certify();
    DialogAnswers answers;
    answers.expectFile(QString::fromStdString(file.string()));
    f.choose("saveCertificate", answers);
  };
  f.open(f.writePath("moving", placeAt(0.03, 0.0)));
  const auto proofs = f.d.folder.path() / "proofs";
  std::filesystem::create_directory(proofs);
  save(proofs / "in.nfcert");
  QTRY_VERIFY(std::filesystem::exists(proofs / "in.nfcert"));
  const Certificate certificate = parseCertificate(readBytes(proofs / "in.nfcert"), proofs / "in.nfcert");
  QCOMPARE(certificate.sceneFile, std::string("../cubes.nearfit"));
  QCOMPARE(certificate.sceneSha256, sha256OfFile(f.d.folder.path() / "cubes.nearfit"));
  QCOMPARE(certificate.pathFile, std::string("../in.nfpath"));
}

void DesktopPathTest::theSeparationsOfferedAreRoundedDown_data() {
  QTest::addColumn<QString>("unit");
  QTest::addColumn<QString>("wanted");
  QTest::addColumn<double>("metres");
  QTest::newRow("millimetres") << QStringLiteral("unit-mm") << QStringLiteral("0.000034 mm") << 3.4e-8;
  QTest::newRow("inches") << QStringLiteral("unit-in") << QStringLiteral("0.0000013 in") << 1.3e-6 * 0.0254;
}

/// A millionth of the diagonal of a cube of 20 mm is 0.0346410 um, or 0.00000136382 in. It was offered as it is, and shown
/// rounded.
void DesktopPathTest::theSeparationsOfferedAreRoundedDown() {
  QFETCH(QString, unit);
  QFETCH(QString, wanted);
  QFETCH(double, metres);
  PathFixture f;
  f.open(f.writePath("moving", placeAt(0.03, 0.0)));
  f.d.choose(unit.toLatin1().constData());
  const std::pair<const char*, std::pair<const char*, const char*>> dialogs[] = {
      {"certifyPath", {"certifyDialog", "pathLength"}}, {"savePath", {"pathDialog", "pathSeparation"}}};
  for (const auto& [command, names] : dialogs) {
    double offered = 0.0;
    QString shown;
    DialogAnswers answers;
    answers.expect(QLatin1String(names.first), [&, field = names.second](QDialog& dialog) {
      const auto* number = dialog.findChild<ui::NumberField*>(QLatin1String(field));
      offered = number->quantity();
      shown = number->text();
      dialog.reject();
      return true;
    });
    f.choose(command, answers);
    QCOMPARE(shown, wanted);
    QVERIFY2(std::abs(offered - metres) < 1e-9 * metres, qPrintable(QString::number(offered)));
  }
  f.d.choose("unit-mm");
}

void DesktopPathTest::whatIsNotProvenIsShownWhereItIs() {
  PathFixture f;
  // 10 mm down, where there are 5 mm of room.
  f.open(f.writePath("moving", placeAt(0.0, -0.01)));
  f.certify();
  const QString result = f.d.text("timelineResult");
  QVERIFY2(result.startsWith(QStringLiteral("Not certified: at 0.500 s “moving” and “fixed”")),
           qPrintable(result));
  QVERIFY(isNear(f.shownTime(), 0.5, 1e-3));
  QVERIFY(!f.d.action("saveCertificate")->isEnabled());
  keepPictures(f.d.window(), QStringLiteral("path-refused"));
}

void DesktopPathTest::aProofEndsWithTheSceneItIsOf() {
  PathFixture f;
  f.open(f.writePath("moving", placeAt(0.03, 0.0)));
  f.certify();
  QVERIFY(f.d.action("saveCertificate")->isEnabled());
  f.d.session().movePart(f.d.partId("fixed"), placeAt(0.0, -0.001));
  QVERIFY(!f.d.action("saveCertificate")->isEnabled());
  QVERIFY(f.d.text("timelineResult").isEmpty());
}

void DesktopPathTest::posesClearancesAnimationAndSweptVolumeAreExported() {
  PathFixture f;
  f.open(f.writePath("moving", placeAt(0.03, 0.0)));
  const auto write = [&f](const char* command, const char* name, const QString& dialog) {
    const auto file = f.d.folder.path() / name;
    DialogAnswers answers;
    if (!dialog.isEmpty()) answers.expectButton(dialog, QDialogButtonBox::Ok);
    answers.expectFile(QString::fromStdString(file.string()));
    f.choose(command, answers);
    // The file is there a moment before the command can be given again.
    [&] { QTRY_VERIFY(std::filesystem::exists(file) && f.d.action(command)->isEnabled()); }();
    return readBytes(file);
  };
  const std::string poses = write("exportPathCsv", "poses.csv", {});
  QVERIFY2(poses.starts_with("t_s,"), poses.c_str());
  const std::string clearances = write("exportPathClearance", "clearances.csv", {});
  QVERIFY2(clearances.starts_with("t_s,fixed [m]\n"), clearances.c_str());
  const std::string animation = write("exportPathGltf", "motion.glb", {});
  QVERIFY(animation.starts_with("glTF"));
  const std::string swept = write("exportSwept", "swept.stl", QStringLiteral("sweptDialog"));
  QVERIFY(swept.size() > 84);
  const std::string named = write("exportSwept", "swept.obj", QStringLiteral("sweptDialog"));
  QVERIFY(named.find("\nv ") != std::string::npos);
  QVERIFY(f.failures.isEmpty());
}

NEARFIT_QT_SUITE(DesktopPathTest, runDesktopTest<DesktopPathTest>)
#include "desktop_path_test.moc"
