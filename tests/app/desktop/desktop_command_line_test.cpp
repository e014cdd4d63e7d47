#include <QFile>
#include <QImage>
#include <QProcess>
#include <QRegularExpression>
#include <filesystem>
#include <set>

#include <sys/stat.h>

#include "tests/app/desktop/desktop_driver.h"
#include "tests/support/places.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

namespace fs = std::filesystem;

struct ProgramOutcome {
  int code = -1;
  QString out, err;
};

ProgramOutcome run(const QStringList& arguments,
                   const QProcessEnvironment& environment = QProcessEnvironment::systemEnvironment()) {
  const TemporaryFolder home;
  QProcessEnvironment own = environment;
  own.insert(QStringLiteral("XDG_CONFIG_HOME"), QString::fromStdString(home.path().string()));
  QProcess process;
  process.setProcessEnvironment(own);
  process.start(QString::fromStdString(test::builtPath("nearfit")), arguments);
  if (!process.waitForFinished(60'000)) return {};
  const int code = process.exitStatus() == QProcess::NormalExit ? process.exitCode() : -1;
  return {code, QString::fromLocal8Bit(process.readAllStandardOutput()),
          QString::fromLocal8Bit(process.readAllStandardError())};
}

QProcessEnvironment withoutDisplay() {
  QProcessEnvironment environment = QProcessEnvironment::systemEnvironment();
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"})
    environment.remove(QLatin1String(name));
  return environment;
}

const QString kUnit = QStringLiteral("--unit"), kMm = QStringLiteral("mm");

}  // namespace

class DesktopCommandLineTest : public QObject {
  Q_OBJECT

 private slots:
  void helpAndVersionNeedNoDisplay();
  void unknownOptionIsAUsageError();
  void aToleranceOutOfRangeIsAUsageError();
  void startsWithoutOpenCascade();
  void unknownUnitIsAUsageError();
  void saysThatThereIsNoDisplay();
  void writesAPictureOfTheFilesAndEnds();
  void aMissingUnitIsAUsageErrorThatNamesTheOption();
  void brokenFileEndsWithAMessage();
  void folderWithoutFilesEndsWithAMessage();
  void picturePathThatCannotBeWrittenEndsWithAMessage();
  void outputsReplaceNeitherInputsNorEachOther();
  void aPictureDoesNotGoIntoAPipe();
};

void DesktopCommandLineTest::helpAndVersionNeedNoDisplay() {
  const ProgramOutcome help = run({QStringLiteral("--help")}, withoutDisplay());
  QCOMPARE(help.code, 0);
  QVERIFY(help.out.contains(QStringLiteral("--screenshot")));
  QVERIFY(help.out.contains(QStringLiteral("--unit")));
  const ProgramOutcome version = run({QStringLiteral("--version")}, withoutDisplay());
  QCOMPARE(version.code, 0);
  QVERIFY(version.out.startsWith(QStringLiteral("nearfit ")));
}

void DesktopCommandLineTest::unknownOptionIsAUsageError() {
  const ProgramOutcome outcome = run({QStringLiteral("--frobnicate")}, withoutDisplay());
  QCOMPARE(outcome.code, 2);
  QVERIFY(outcome.err.startsWith(QStringLiteral("nearfit: ")));
  QVERIFY(outcome.err.contains(QStringLiteral("--frobnicate")));
  QCOMPARE(outcome.err.count(QLatin1Char('\n')), 1);
}

void DesktopCommandLineTest::aToleranceOutOfRangeIsAUsageError() {
  for (const char* option : {"--chord", "--angle"}) {
    const ProgramOutcome outcome =
        run({QStringLiteral("a.step"), QLatin1String(option), QStringLiteral("1e9")}, withoutDisplay());
    QCOMPARE(outcome.code, 2);
    QVERIFY2(outcome.err.startsWith(QStringLiteral("nearfit: %1: ").arg(QLatin1String(option))),
             qPrintable(outcome.err));
    QCOMPARE(outcome.err.count(QLatin1Char('\n')), 1);
  }
}

/// Only the programs that read and write CAD files are linked to it.
void DesktopCommandLineTest::startsWithoutOpenCascade() {
  QProcess ldd;
  ldd.start(QStringLiteral("ldd"), {QString::fromStdString(test::builtPath("nearfit"))});
  QVERIFY(ldd.waitForFinished(60'000));
  QCOMPARE(ldd.exitCode(), 0);
  const QString libraries = QString::fromLocal8Bit(ldd.readAllStandardOutput());
  QVERIFY2(libraries.contains(QStringLiteral("libQt5Widgets")), qPrintable(libraries));
  QVERIFY2(!libraries.contains(QRegularExpression(QStringLiteral("libTK[A-Z]"))), qPrintable(libraries));
}

void DesktopCommandLineTest::unknownUnitIsAUsageError() {
  const ProgramOutcome outcome =
      run({QStringLiteral("a.stl"), QStringLiteral("--unit"), QStringLiteral("mile")}, withoutDisplay());
  QCOMPARE(outcome.code, 2);
  QVERIFY(outcome.err.startsWith(QStringLiteral("nearfit: --unit: \"mile\"")));
  QCOMPARE(outcome.err.count(QLatin1Char('\n')), 1);
}

void DesktopCommandLineTest::saysThatThereIsNoDisplay() {
  const ProgramOutcome outcome = run({}, withoutDisplay());
  QCOMPARE(outcome.code, 1);
  QVERIFY(outcome.err.contains(QStringLiteral("display")));
}

void DesktopCommandLineTest::writesAPictureOfTheFilesAndEnds() {
  const TemporaryFolder folder;
  const QString box = writeOff(folder.path() / "box.off", boxMesh(glm::dvec3(0.04)));
  const QString picture = QString::fromStdString((folder.path() / "window.png").string());
  const ProgramOutcome outcome = run({box, kUnit, kMm, QStringLiteral("--screenshot"), picture});
  QVERIFY2(outcome.code == 0, qPrintable(outcome.err));
  const QImage image(picture);
  QCOMPARE(image.size(), QSize(1280, 800));
  // A lit box on a gradient: the middle of the window is anything but one colour.
  std::set<QRgb> tones;
  for (int x = 400; x < 900; x += 5) {
    for (int y = 200; y < 600; y += 5)
      tones.insert(image.pixel(x, y));
  }
  QVERIFY2(tones.size() > 40, qPrintable(QString::number(tones.size())));
}

// It read millimetres, whatever the file was in.
void DesktopCommandLineTest::aMissingUnitIsAUsageErrorThatNamesTheOption() {
  const TemporaryFolder folder;
  const QString box = writeOff(folder.path() / "box.off", boxMesh(glm::dvec3(0.04)));
  const QString picture = QString::fromStdString((folder.path() / "window.png").string());
  const ProgramOutcome outcome = run({box, QStringLiteral("--screenshot"), picture});
  QCOMPARE(outcome.code, 2);
  QVERIFY2(outcome.err.contains(QStringLiteral("nearfit: --unit: ") + box), qPrintable(outcome.err));
  QVERIFY(!QFile::exists(picture));
}

void DesktopCommandLineTest::brokenFileEndsWithAMessage() {
  const TemporaryFolder folder;
  const auto broken = folder.write("broken.stl", "this is no mesh");
  const QString picture = QString::fromStdString((folder.path() / "window.png").string());
  const ProgramOutcome outcome =
      run({QString::fromStdString(broken.string()), kUnit, kMm, QStringLiteral("--screenshot"), picture});
  QCOMPARE(outcome.code, 1);
  const QString line = outcome.err.mid(outcome.err.indexOf(QStringLiteral("nearfit: ")));
  QVERIFY2(line.contains(QStringLiteral("broken.stl")), qPrintable(outcome.err));
  QCOMPARE(line.count(QLatin1Char('\n')), 1);
  QVERIFY(!QFile::exists(picture));
}

void DesktopCommandLineTest::folderWithoutFilesEndsWithAMessage() {
  const TemporaryFolder folder, empty;
  const QString picture = QString::fromStdString((folder.path() / "window.png").string());
  const QString nothing = QString::fromStdString(empty.path().string());
  const ProgramOutcome outcome = run({nothing, QStringLiteral("--screenshot"), picture});
  QCOMPARE(outcome.code, 1);
  QVERIFY2(outcome.err.contains(QStringLiteral("Nothing to open in ") + nothing), qPrintable(outcome.err));
  QVERIFY(!QFile::exists(picture));
}

void DesktopCommandLineTest::picturePathThatCannotBeWrittenEndsWithAMessage() {
  const TemporaryFolder folder;
  const QString box = writeOff(folder.path() / "box.off", boxMesh(glm::dvec3(0.04)));
  const ProgramOutcome outcome =
      run({box, kUnit, kMm, QStringLiteral("--screenshot"), QStringLiteral("/no/such/folder/window.png")});
  QCOMPARE(outcome.code, 1);
  QVERIFY(outcome.err.contains(QStringLiteral("/no/such/folder/window.png")));
}

/// With OUT forgotten, the scene was replaced by its picture.
void DesktopCommandLineTest::outputsReplaceNeitherInputsNorEachOther() {
  const TemporaryFolder folder;
  const auto nameOf = [&](const char* file) {
    return QString::fromStdString((folder.path() / file).string());
  };
  const QByteArray content("the scene");
  folder.write("fit.nearfit", content.toStdString());
  folder.write("felt.csv", content.toStdString());
  fs::create_symlink("fit.nearfit", folder.path() / "link.png");
  const QString scene = nameOf("fit.nearfit"), felt = nameOf("felt.csv"), picture = nameOf("a.png");
  const QString screenshot = QStringLiteral("--screenshot"), record = QStringLiteral("--record");
  for (const QStringList& arguments :
       {QStringList{screenshot, scene}, QStringList{scene, screenshot, nameOf("link.png")},
        QStringList{scene, record, nameOf("./fit.nearfit")},
        QStringList{scene, screenshot, picture, record, nameOf("./a.png")},
        QStringList{scene, QStringLiteral("--device"), QStringLiteral("replay:") + felt, record, felt},
        QStringList{QStringLiteral("--script"), felt, record, felt},
        QStringList{scene, QStringLiteral("--script"), felt}}) {
    const ProgramOutcome outcome = run(arguments);
    QVERIFY2(outcome.code == 2, qPrintable(arguments.join(QChar(' ')) + outcome.err));
  }
  for (const QString& file : {scene, felt}) {
    QFile kept(file);
    QVERIFY(kept.open(QIODevice::ReadOnly));
    QCOMPARE(kept.readAll(), content);
  }
  QVERIFY(!QFile::exists(picture));
}

/// It waited for a reader that never came.
void DesktopCommandLineTest::aPictureDoesNotGoIntoAPipe() {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe.png";
  QCOMPARE(::mkfifo(pipe.c_str(), 0600), 0);
  const ProgramOutcome outcome = run({QStringLiteral("--screenshot"), QString::fromStdString(pipe.string())});
  QCOMPARE(outcome.code, 1);
  QVERIFY2(outcome.err.contains(QStringLiteral("a device, a pipe or a socket")), qPrintable(outcome.err));
  QVERIFY(fs::is_fifo(pipe));
}

NEARFIT_QT_SUITE(DesktopCommandLineTest, runDesktopTest<DesktopCommandLineTest>)
#include "desktop_command_line_test.moc"
