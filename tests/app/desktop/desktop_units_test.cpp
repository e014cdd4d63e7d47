// The unit of mesh files: asked for with the size that each gives, given on the command line, changed later.
#include <QRadioButton>
#include <QRegularExpression>
#include <QStatusBar>
#include <QToolButton>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <variant>

#include "app/desktop/command_line.h"
#include "core/scene/part_geometry.h"
#include "tests/app/desktop/file_drop.h"
#include "ui/model/selection.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// Waits until a question for a unit shows sizes, and returns that of a unit.
QString sizeIn(QDialog* question, const char* unit) {
  auto* accept = question->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok);
  [&] { QTRY_VERIFY(accept->isEnabled()); }();
  return question->findChild<QLabel*>(QStringLiteral("size-") + QLatin1String(unit))->text();
}

/// The unit that a question offers once it shows sizes.
QString offeredBy(QDialog* question) {
  sizeIn(question, "mm");
  for (const QRadioButton* choice : question->findChildren<QRadioButton*>()) {
    if (choice->isChecked()) return choice->objectName();
  }
  return {};
}

/// Acts on the next question for a unit.
void whenAsked(const std::function<void(QDialog*)>& act) {
  whenModal<QDialog>(act, QStringLiteral("unitDialog"));
}

/// Counts questions for a unit while it exists, and cancels them.
class Questions {
 public:
  Questions() {
    timer_.setInterval(5);
    QObject::connect(&timer_, &QTimer::timeout, &timer_, [this] {
      auto* dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
      if (dialog == nullptr || dialog->objectName() != QStringLiteral("unitDialog")) return;
      ++count_;
      dialog->reject();
    });
    timer_.start();
  }
  int count() const { return count_; }

 private:
  QTimer timer_;
  int count_ = 0;
};

template <std::size_t Count>
std::variant<desktop::Options, int> parsed(const std::array<const char*, Count>& arguments) {
  return desktop::parseCommandLine(static_cast<int>(Count), arguments.data());
}

}  // namespace

class DesktopUnitsTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void eachUnitShowsTheSizeThatItGives();
  void longSizesAreNotClipped();
  void severalFilesAreMeasuredTogether();
  void sizesAreInTheUnitOfLengthShown();
  void theUnitNearestToTheSizeOfAHandOrTheScenesPartsIsOffered();
  void theUnitChosenBeforeForTheFolderOrTheTypeIsOffered();
  void theUnitChosenBeforeIsNotOfferedWhereItGivesAnOddSize();
  void filesThatCannotBeReadAreNotAskedAbout();
  void theCommandLineTakesTheSpellingOfTheOtherProgram();
  void anUnattendedRunRefusesToGuessAUnit();
  void filesOfTheCommandLineAreAskedAbout();
  void filesOfTheCommandLineWithAUnitAreNot();
  void aCancelledQuestionAddsNothing();
  void anotherUnitIsAnImportInItAndOneStep();
  void theViewAndTheStatusBarFollowTheUnit();
  void theNoticeOfAnOddSizeFollowsTheUnit();
  void severalPartsChangeTheirUnitInOneStep();
  void theUnitStaysWhileAPartIsFelt();
  void aFileThatHasChangedIsNotReadInAnotherUnit();
  void lockedPartsKeepTheirUnit();
};

void DesktopUnitsTest::eachUnitShowsTheSizeThatItGives() {
  DesktopDriver d;
  const QString file = writeOff(d.folder.path() / "peg.off", boxMesh({0.053, 0.016, 0.012}, {1.0, 0.0, 0.0}));
  whenModal<QFileDialog>([&](QFileDialog* dialog) {
    whenAsked([](QDialog* question) {
      QCOMPARE(sizeIn(question, "mm"), QStringLiteral("53 × 16 × 12 mm"));
      QCOMPARE(sizeIn(question, "m"), QStringLiteral("53 × 16 × 12 m"));
      QCOMPARE(sizeIn(question, "um"), QStringLiteral("53 × 16 × 12 µm"));
      QCOMPARE(sizeIn(question, "cm"), QStringLiteral("530 × 160 × 120 mm"));
      QCOMPARE(sizeIn(question, "in"), QStringLiteral("1.346 × 0.4064 × 0.3048 m"));
      QCOMPARE(question->findChild<QLabel*>(QStringLiteral("unitQuestion"))->text(),
               QStringLiteral("“peg.off” stores no unit. What unit is it in?"));
      keepPictures(*question, QStringLiteral("unit"));
      answerUnit(question, "cm");
    });
    chooseFile(dialog, file);
  });
  d.choose("addParts");
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{1});
  QVERIFY(isNear(widthOf(d.part("peg")), 0.53, 1e-12));
}

/// Sizes that arrived in the open dialog lost their first digit.
void DesktopUnitsTest::longSizesAreNotClipped() {
  DesktopDriver d;
  const QString file = writeOff(d.folder.path() / "housing.off", boxMesh({0.1124, 0.2251, 0.1396}));
  whenAsked([](QDialog* question) {
    sizeIn(question, "mm");
    for (const QLabel* label : question->findChildren<QLabel*>(QRegularExpression(QStringLiteral("^size-"))))
      QTRY_VERIFY2(label->width() >= label->sizeHint().width(), qPrintable(label->text()));
    QTest::keyClick(question, Qt::Key_Escape);
  });
  d.window().document().openFiles({file});
}

void DesktopUnitsTest::severalFilesAreMeasuredTogether() {
  DesktopDriver d;
  // The cubes: 40 mm from -20 on, and 20 mm up to 45 mm.
  whenAsked([](QDialog* question) {
    QCOMPARE(sizeIn(question, "mm"), QStringLiteral("40 × 40 × 65 mm"));
    QCOMPARE(
        question->findChild<QLabel*>(QStringLiteral("unitQuestion"))->text(),
        QStringLiteral("These formats store no unit. What unit are these 2 files in? The sizes are those "
                       "of all files together."));
    answerUnit(question);
  });
  drop(d.window(), {d.fixedFile, d.movingFile});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{2});
}

void DesktopUnitsTest::sizesAreInTheUnitOfLengthShown() {
  DesktopDriver d;
  d.choose("unit-cm");
  whenAsked([](QDialog* question) {
    QCOMPARE(sizeIn(question, "mm"), QStringLiteral("4 × 4 × 4 cm"));
    QTest::keyClick(question, Qt::Key_Escape);
  });
  d.window().document().openFiles({d.fixedFile});
  d.choose("unit-mm");
}

/// The unit chosen last was offered, in any run and for any file, and millimetres at first.
void DesktopUnitsTest::theUnitNearestToTheSizeOfAHandOrTheScenesPartsIsOffered() {
  DesktopDriver d;
  // The numbers in the files: 50, 5 and 0.1 along each axis.
  const std::pair<double, const char*> cases[] = {{50.0, "unit-mm"}, {5.0, "unit-in"}, {0.1, "unit-m"}};
  for (const auto& [edge, unit] : cases) {
    const QString file = writeOff(d.folder.path() / "box.off", boxMesh(glm::dvec3(1e-3 * edge)));
    QString offered;
    whenAsked([&](QDialog* question) {
      offered = offeredBy(question);
      QTest::keyClick(question, Qt::Key_Escape);
    });
    d.window().document().openFiles({file});
    QCOMPARE(offered, QString::fromLatin1(unit));
  }
  // Among parts of 5 mm, the file of 5 is in millimetres.
  d.add({writeOff(d.folder.path() / "small.off", boxMesh(glm::dvec3(5e-3)))});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{1});
  const QString file = writeOff(d.folder.path() / "box.off", boxMesh(glm::dvec3(5e-3)));
  QString offered;
  whenAsked([&](QDialog* question) {
    offered = offeredBy(question);
    QTest::keyClick(question, Qt::Key_Escape);
  });
  d.window().document().openFiles({file});
  QCOMPARE(offered, QStringLiteral("unit-mm"));
}

void DesktopUnitsTest::theUnitChosenBeforeForTheFolderOrTheTypeIsOffered() {
  DesktopDriver d;
  const auto folder = [&](const char* name) {
    std::filesystem::create_directory(d.folder.path() / name);
    return d.folder.path() / name;
  };
  const auto a = folder("a"), b = folder("b");
  // All of 50 units: millimetres by their size.
  const TriangleMesh box = boxMesh(glm::dvec3(0.05));
  const auto writeObj = [](const std::filesystem::path& file) {
    std::ofstream(file) << "v 0 0 0\nv 50 0 0\nv 0 50 0\nv 0 0 50\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    return nameOf(file);
  };
  const auto offeredFor = [&](const QString& file, const char* answer) {
    QString offered;
    const std::size_t before = d.session().scene().parts().size();
    whenAsked([&](QDialog* question) {
      offered = offeredBy(question);
      answerUnit(question, answer);
    });
    d.window().document().openFiles({file});
    if (!QTest::qWaitFor([&] { return d.session().scene().parts().size() > before; }, kQtPatienceMs))
      return QStringLiteral("nothing came");
    d.session().reset();
    return offered;
  };
  QCOMPARE(offeredFor(writeOff(a / "one.off", box), "cm"), QStringLiteral("unit-mm"));
  QCOMPARE(offeredFor(writeOff(a / "two.off", box), "cm"), QStringLiteral("unit-cm"));
  // The folder goes before the type, which is known from elsewhere.
  QCOMPARE(offeredFor(writeOff(b / "one.off", box), "in"), QStringLiteral("unit-cm"));
  QCOMPARE(offeredFor(writeOff(a / "three.off", box), "cm"), QStringLiteral("unit-cm"));
  QCOMPARE(offeredFor(writeObj(b / "one.obj"), "in"), QStringLiteral("unit-in"));
  QCOMPARE(offeredFor(writeObj(folder("c") / "one.obj"), "in"), QStringLiteral("unit-in"));
}

/// A part of 1.5 mm came of micrometres that were chosen for other files of the folder.
void DesktopUnitsTest::theUnitChosenBeforeIsNotOfferedWhereItGivesAnOddSize() {
  DesktopDriver d;
  const auto offeredFor = [&](const char* name, double edge, const char* answer) {
    const QString file = writeOff(d.folder.path() / name, boxMesh(glm::dvec3(edge)));
    QString offered;
    whenAsked([&](QDialog* question) {
      offered = offeredBy(question);
      if (answer == nullptr) return question->reject();
      answerUnit(question, answer);
    });
    drop(d.window(), {file});
    (void)QTest::qWaitFor([&] { return !offered.isEmpty(); }, kQtPatienceMs);
    return offered;
  };
  // 80,000 units along each axis: 80 mm in micrometres.
  QCOMPARE(offeredFor("large.off", 80.0, "um"), QStringLiteral("unit-um"));
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{1});
  // 1500 units: 1.5 mm in micrometres, which is within a factor of 1000 of the 80 mm; in an empty scene it is odd.
  QCOMPARE(offeredFor("small.off", 1.5, nullptr), QStringLiteral("unit-um"));
  d.session().reset();
  QCOMPARE(offeredFor("small.off", 1.5, nullptr), QStringLiteral("unit-mm"));
  QCOMPARE(offeredFor("large.off", 80.0, "um"), QStringLiteral("unit-um"));
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{1});
  // 50 units: 0.05 mm in micrometres, more than 1000 times smaller than the part.
  QCOMPARE(offeredFor("tiny.off", 0.05, nullptr), QStringLiteral("unit-mm"));
}

void DesktopUnitsTest::filesThatCannotBeReadAreNotAskedAbout() {
  DesktopDriver d;
  QStringList told;
  d.window().setFailureSink(
      [&](const ui::Failure& failure) { told << failure.summary + QChar('\n') + failure.details; });
  d.window().document().openFiles({nameOf(d.folder.write("bad.off", "OFF\nnonsense\n"))});
  QTRY_COMPARE(told.size(), 1);
  QVERIFY2(told.first().startsWith(QStringLiteral("“bad.off” could not be loaded. Nothing was added.\n")),
           qPrintable(told.first()));
  QVERIFY(d.session().scene().parts().empty());
}

void DesktopUnitsTest::theCommandLineTakesTheSpellingOfTheOtherProgram() {
  const auto unitOf = [](const char* text) {
    return std::get<desktop::Options>(parsed(std::array{"nearfit", "a.stl", "--unit", text})).metresPerUnit;
  };
  QCOMPARE(unitOf("cm").value(), 0.01);
  QCOMPARE(unitOf("um").value(), 1e-6);
  QCOMPARE(unitOf("ft").value(), 0.3048);
  QCOMPARE(unitOf("0.0254").value(), 0.0254);
  QVERIFY(!std::get<desktop::Options>(parsed(std::array{"nearfit", "a.stl"})).metresPerUnit);
  for (const char* text : {"mile", "0", "nan"})
    QCOMPARE(std::get<int>(parsed(std::array{"nearfit", "a.stl", "--unit", text})), 2);
  QCOMPARE(std::get<int>(parsed(std::array{"nearfit", "--unit", "mm"})), 2);
}

void DesktopUnitsTest::anUnattendedRunRefusesToGuessAUnit() {
  const auto errorFor = [](const auto& arguments, const QStringList& files) {
    try {
      desktop::requireUnit(std::get<desktop::Options>(parsed(arguments)), files);
    } catch (const UsageError& error) {
      return QString::fromStdString(error.what());
    }
    return QString();
  };
  const std::array picture{"nearfit", "a.stl", "--screenshot", "a.png"};
  const std::array timed{"nearfit", "a.stl", "--device", "replay:a.csv", "--seconds", "1"};
  QVERIFY(!std::get<desktop::Options>(parsed(picture)).metresPerUnit);
  for (const QString& error : {errorFor(picture, {QStringLiteral("a.stl")}),
                               errorFor(timed, {QStringLiteral("b.step"), QStringLiteral("a.stl")})})
    QVERIFY2(error.startsWith(QStringLiteral("--unit: a.stl stores no unit")), qPrintable(error));
  QVERIFY(errorFor(picture, {QStringLiteral("a.brep")}).contains(QStringLiteral("a.brep")));
  const TemporaryFolder folder;
  folder.write("inner.off", "OFF");
  const QString inFolder = errorFor(picture, {nameOf(folder.path())});
  QVERIFY2(inFolder.contains(QStringLiteral("inner.off")), qPrintable(inFolder));
  // Files that store their unit, scenes, a unit that is given, and a window in which somebody can answer.
  QCOMPARE(errorFor(picture, {QStringLiteral("a.step"), QStringLiteral("a.nearfit")}), QString());
  const std::array given{"nearfit", "a.stl", "--unit", "m", "--screenshot", "a.png"};
  QCOMPARE(errorFor(given, {QStringLiteral("a.stl")}), QString());
  QCOMPARE(std::get<desktop::Options>(parsed(given)).metresPerUnit.value(), 1.0);
  QCOMPARE(errorFor(std::array{"nearfit", "a.stl"}, {QStringLiteral("a.stl")}), QString());
}

void DesktopUnitsTest::filesOfTheCommandLineAreAskedAbout() {
  DesktopDriver d;
  whenAsked([](QDialog* question) { answerUnit(question, "in"); });
  d.application.show({d.fixedFile}, false);
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{1});
  QCOMPARE(d.part("fixed").geometry->metresPerUnit, 0.0254);
  // The answer is offered the next time.
  whenAsked([](QDialog* question) {
    QVERIFY(question->findChild<QRadioButton*>(QStringLiteral("unit-in"))->isChecked());
    answerUnit(question);
  });
  d.window().document().openFiles({d.movingFile});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{2});
  QCOMPARE(d.part("moving").geometry->metresPerUnit, 0.0254);
}

void DesktopUnitsTest::filesOfTheCommandLineWithAUnitAreNot() {
  DesktopDriver d;
  Questions questions;
  d.application.show({d.fixedFile, d.movingFile}, false, 0.01);
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{2});
  QCOMPARE(questions.count(), 0);
  QCOMPARE(d.part("fixed").geometry->metresPerUnit, 0.01);
  QCOMPARE(d.part("moving").geometry->metresPerUnit, 0.01);
}

void DesktopUnitsTest::aCancelledQuestionAddsNothing() {
  DesktopDriver d;
  bool hasEnded = false, isComplete = true;
  connect(&d.window().document(), &ui::Document::loaded, this, [&](bool is) {
    hasEnded = true;
    isComplete = is;
  });
  Questions questions;
  d.window().document().openFiles({d.fixedFile});
  QVERIFY(hasEnded && !isComplete);
  QCOMPARE(questions.count(), 1);
  QVERIFY(!d.window().document().isBusy());
  QVERIFY(d.session().scene().parts().empty());
}

void DesktopUnitsTest::anotherUnitIsAnImportInItAndOneStep() {
  DesktopDriver d;
  d.addCubes();
  const RigidTransform pose{{0.5, 0.5, 0.5, 0.5}, {0.1, 0.2, 0.3}};
  d.session().movePart(d.partId("fixed"), pose);
  const std::size_t steps = d.session().historyIndex();
  d.window().selection().select(d.partId("fixed"));
  whenAsked([](QDialog* question) {
    QCOMPARE(sizeIn(question, "mm"), QStringLiteral("40 × 40 × 40 mm"));
    QCOMPARE(sizeIn(question, "in"), QStringLiteral("1.016 × 1.016 × 1.016 m"));
    QVERIFY(question->findChild<QLabel*>(QStringLiteral("knownSizes"))
                ->text()
                .contains(QStringLiteral("what else is in the scene, 20 × 20 × 20 mm")));
    const auto* present = question->findChild<QRadioButton*>(QStringLiteral("unit-mm"));
    QVERIFY(present->isChecked() && present->text().contains(QStringLiteral("now")));
    answerUnit(question, "in");
  });
  d.choose("changeUnit");
  QTRY_COMPARE(d.part("fixed").geometry->metresPerUnit, 0.0254);
  QTRY_VERIFY2(d.window().statusBar()->currentMessage().endsWith(QStringLiteral("Undo to revert.")),
               qPrintable(d.window().statusBar()->currentMessage()));
  QCOMPARE(d.session().historyIndex(), steps + 1);
  QCOMPARE(d.session().undoText(), std::string("Change the unit of fixed"));
  QCOMPARE(d.part("fixed").worldFromPart.translation, pose.translation);
  QCOMPARE(d.part("fixed").worldFromPart.rotation, pose.rotation);
  QCOMPARE(widthOf(d.part("moving")), 0.02);
  const PartGeometryPtr imported = loadPartGeometry(d.fixedFile.toStdString(), 0.0254);
  const auto changed = d.part("fixed").geometry->mesh.vertices(), expected = imported->mesh.vertices();
  QVERIFY(std::equal(changed.begin(), changed.end(), expected.begin(), expected.end()));
  QCOMPARE(d.part("fixed").geometry->mass.volume, imported->mass.volume);
  d.choose("undo");
  QCOMPARE(widthOf(d.part("fixed")), 0.04);
  QCOMPARE(d.part("fixed").geometry->metresPerUnit, 1e-3);
  QCOMPARE(d.part("fixed").worldFromPart.translation, pose.translation);
  d.choose("redo");
  QCOMPARE(d.part("fixed").geometry->metresPerUnit, 0.0254);
}

/// After Undo the view stayed where the parts were a thousand times larger.
void DesktopUnitsTest::theViewAndTheStatusBarFollowTheUnit() {
  DesktopDriver d;
  d.addCubes();
  const auto pixel = [&] { return d.window().viewport().projection().metresPerPixel(glm::dvec3(0.0)); };
  d.choose("fit");
  const double before = pixel();
  d.window().selection().select(d.partId("fixed"));
  whenAsked([](QDialog* question) { answerUnit(question, "m"); });
  d.choose("changeUnit");
  QTRY_COMPARE(widthOf(d.part("fixed")), 40.0);
  QTRY_VERIFY(pixel() > 100.0 * before);
  const QString told = d.window().statusBar()->currentMessage();
  QVERIFY2(told.contains(QStringLiteral("Change the unit of fixed")), qPrintable(told));
  d.choose("undo");
  QTRY_VERIFY(std::abs(pixel() / before - 1.0) < 0.01);
}

/// It stayed, and its button made the right part a thousand times smaller.
void DesktopUnitsTest::theNoticeOfAnOddSizeFollowsTheUnit() {
  DesktopDriver d;
  d.addCubes();
  d.add({writeOff(d.folder.path() / "huge.off", boxMesh(glm::dvec3(30.0)))});
  const auto offer = [&] {
    auto* notice = d.widget<QWidget>("notice-rescale");
    if (notice == nullptr || !notice->isVisible()) return QString();
    return notice->findChild<QPushButton*>(QStringLiteral("choice1"))->text().remove(QChar(','));
  };
  QTRY_COMPARE(offer(), QStringLiteral("Make 1000 times smaller"));
  d.window().selection().select(d.partId("huge"));
  whenAsked([](QDialog* question) { answerUnit(question, "um"); });
  d.choose("changeUnit");
  QTRY_COMPARE(d.part("huge").geometry->metresPerUnit, 1e-6);
  QTRY_COMPARE(offer(), QString());
  d.choose("undo");
  QTRY_COMPARE(offer(), QStringLiteral("Make 1000 times smaller"));
  QTest::mouseClick(d.widget<QWidget>("notice-rescale")->findChild<QToolButton*>(QStringLiteral("dismiss")),
                    Qt::LeftButton);
  QTRY_COMPARE(offer(), QString());
  d.choose("redo");
  d.choose("undo");
  QCOMPARE(offer(), QString());
}

void DesktopUnitsTest::severalPartsChangeTheirUnitInOneStep() {
  DesktopDriver d;
  d.addCubes();
  const std::size_t steps = d.session().historyIndex();
  d.window().selection().set({d.partId("fixed"), d.partId("moving")});
  whenAsked([](QDialog* question) {
    QCOMPARE(sizeIn(question, "cm"), QStringLiteral("400 × 400 × 650 mm"));
    answerUnit(question, "cm");
  });
  d.choose("changeUnit");
  QTRY_COMPARE(d.part("moving").geometry->metresPerUnit, 1e-2);
  QCOMPARE(d.part("fixed").geometry->metresPerUnit, 1e-2);
  QCOMPARE(d.session().historyIndex(), steps + 1);
  d.choose("undo");
  QCOMPARE(widthOf(d.part("fixed")), 0.04);
  QCOMPARE(widthOf(d.part("moving")), 0.02);
}

void DesktopUnitsTest::theUnitStaysWhileAPartIsFelt() {
  DesktopDriver d;
  d.addCubes();
  d.startWith(ui::Hand::Manual);
  d.window().selection().select(d.partId("moving"));
  Questions questions;
  QVERIFY(d.action("changeUnit")->isEnabled());
  // A menu that closes may clear the status bar.
  d.action("changeUnit")->trigger();
  QVERIFY2(d.window().statusBar()->currentMessage().contains(QStringLiteral("Stop (F6)")),
           qPrintable(d.window().statusBar()->currentMessage()));
  QCOMPARE(questions.count(), 0);
  QVERIFY(d.application.servo().isRunning());
  QCOMPARE(widthOf(d.part("moving")), 0.02);
  d.choose("stop");
}

void DesktopUnitsTest::aFileThatHasChangedIsNotReadInAnotherUnit() {
  DesktopDriver d;
  d.addCubes();
  QStringList told;
  d.window().setFailureSink([&](const ui::Failure& failure) { told << failure.details; });
  writeOff(d.fixedFile.toStdString(), boxMesh(glm::dvec3(0.05)));
  d.window().selection().select(d.partId("fixed"));
  whenAsked([](QDialog* question) { answerUnit(question, "cm"); });
  d.choose("changeUnit");
  QTRY_COMPARE(told.size(), 1);
  QVERIFY2(told.first().contains(QStringLiteral("changed since it was read")), qPrintable(told.first()));
  QCOMPARE(widthOf(d.part("fixed")), 0.04);
}

void DesktopUnitsTest::lockedPartsKeepTheirUnit() {
  DesktopDriver d;
  d.addCubes();
  d.window().selection().set({d.partId("fixed"), d.partId("moving")});
  QVERIFY(d.action("changeUnit")->isEnabled());
  d.session().setLocked(d.partId("fixed"), true);
  QVERIFY(!d.action("changeUnit")->isEnabled());
  d.window().selection().select(d.partId("moving"));
  QVERIFY(d.action("changeUnit")->isEnabled());
  d.window().selection().select(std::nullopt);
  QVERIFY(!d.action("changeUnit")->isEnabled());
}

NEARFIT_QT_SUITE(DesktopUnitsTest, runDesktopTest<DesktopUnitsTest>)
#include "desktop_units_test.moc"
