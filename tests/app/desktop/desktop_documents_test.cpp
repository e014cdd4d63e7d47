// CAD documents in the window, made by an importer that stands in for the program that reads them.
#include <QAction>
#include <QPushButton>
#include <QStatusBar>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <optional>
#include <thread>
#include <variant>

#include "app/desktop/command_line.h"
#include "core/files/sha256.h"
#include "core/scene/scene_tree.h"
#include "tests/app/desktop/dialog_answers.h"
#include "tests/app/desktop/file_drop.h"
#include "tests/support/documents.h"
#include "ui/files/import_tessellation.h"
#include "ui/model/selection.h"
#include "ui/widgets/number_field.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// The application, and a vise in a file.
class DocumentDesk : public DesktopDriver {
 public:
  DocumentDesk() { vise = nameOf(folder.write("vise.step", "the vise")); }

  void open() {
    drop(window(), {vise});
    QTRY_COMPARE(session().scene().parts().size(), std::size_t{3});
  }
  std::size_t trianglesOf(const char* name) { return part(name).geometry->mesh.triangles().size(); }

  FakeImporter importer;
  QString vise;
};

/// Answers the dialog for the triangles of documents that are added: its own chord, in millimetres, or automatic.
DialogAnswers::Answer triangles(const char* chord) {
  return [chord](QDialog& dialog) {
    auto* automatic = dialog.findChild<QAbstractButton*>(QStringLiteral("refineAutomatic"));
    if (automatic->isChecked() != (chord == nullptr)) {
      automatic->setFocus();
      QTest::keyClick(automatic, Qt::Key_Space);
    }
    if (chord != nullptr) {
      auto* field = dialog.findChild<ui::NumberField*>(QStringLiteral("refineChord"));
      field->setFocus();
      field->selectAll();
      QTest::keyClicks(field, QLatin1String(chord));
      keepPictures(dialog, QStringLiteral("import-triangles"));
    }
    QTest::mouseClick(dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok), Qt::LeftButton);
    return !dialog.isVisible();
  };
}

template <std::size_t Count>
std::variant<desktop::Options, int> parsedLine(const std::array<const char*, Count>& arguments) {
  return desktop::parseCommandLine(static_cast<int>(Count), arguments.data());
}

}  // namespace

class DesktopDocumentsTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void aDroppedDocumentKeepsItsTreeAndIsOneStep();
  void partsThatCameTogetherShowTheirOwnColours();
  void itsUnitIsNotAskedFor();
  void filesWithoutAUnitBesideItAreAskedAboutWithKnownSizes();
  void aDroppedRobotBringsItsMeshesOnceAndNobodyAsksForTheirUnit();
  void compressedFilesAreOfferedWhereTheyAreRead();
  void itsUnitCannotBeChangedAndTheToolTipTellsTheReason();
  void aGltfInMillimetresIsPointedOutAndCorrectedAsAWhole();
  void a3mfThatStatesAWrongUnitIsCorrectedAsAWhole();
  void itHasTheTrianglesThatWereChosenBeforeItWasAdded();
  void theChoiceOfTrianglesIsKeptAndCanBeTakenBack();
  void trianglesOfTheCommandLineGoBeforeTheChoice();
  void anUnattendedRunDoesNotDependOnTheChoiceOfTriangles();
  void refiningAPartTakesItsInstancesAlongAndIsOneStep();
  void refiningSaysSoWithTheNameOfThePart();
  void finerAndCoarserScaleTheTolerances();
  void meshesCannotBeRefined();
  void aSavedSceneComesBack();
  void aChangedDocumentIsReloadedInPlace();
  void aChangedCompanionIsOfferedAndReloaded();
  void aDocumentThatFailsIsToldAndTheOthersAreAdded();
  void openReplacesTheSceneByThatOfADocumentUnlessItCannotBeRead();
};

void DesktopDocumentsTest::aDroppedDocumentKeepsItsTreeAndIsOneStep() {
  DocumentDesk d;
  d.open();
  QCOMPARE(d.session().historyIndex(), std::size_t{1});
  QCOMPARE(d.session().undoText(), std::string("Add vise"));
  const Scene& scene = d.session().scene();
  QCOMPARE(scene.groups().size(), std::size_t{2});
  QCOMPARE(scene.findGroup(*d.part("pin 2").group)->name, std::string("jaws"));
  QCOMPARE(d.part("pin 2").worldFromPart.translation, glm::dvec3(0.1, 0.02, 0.0));
  QVERIFY((d.part("pin 2").colour == Colour{0.0F, 0.0F, 1.0F}));
  QCOMPARE(d.part("pin").geometry, d.part("pin 2").geometry);
  d.choose("undo");
  QVERIFY(d.session().scene().parts().empty() && d.session().scene().groups().empty());
}

/// All were selected, and drawn in the blue of a selection.
void DesktopDocumentsTest::partsThatCameTogetherShowTheirOwnColours() {
  DocumentDesk d;
  d.add({d.fixedFile});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{1});
  d.window().selection().select(d.partId("fixed"));
  drop(d.window(), {d.vise});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{4});
  QTRY_VERIFY(!d.window().document().isBusy());
  QVERIFY(d.window().selection().isEmpty());
  // The selection is no part of the step.
  d.choose("undo");
  d.choose("redo");
  QVERIFY(d.window().selection().isEmpty());
  QCOMPARE(d.session().scene().parts().size(), std::size_t{4});
}

void DesktopDocumentsTest::itsUnitIsNotAskedFor() {
  DocumentDesk d;
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, d.vise); });
  d.choose("addParts");
  // A question would hold it up.
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  QVERIFY(isNear(widthOf(d.part("body")), 0.1, 1e-15));
}

void DesktopDocumentsTest::filesWithoutAUnitBesideItAreAskedAboutWithKnownSizes() {
  DocumentDesk d;
  d.open();
  whenModal<QDialog>(
      [](QDialog* question) {
        const QString asked = question->findChild<QLabel*>(QStringLiteral("unitQuestion"))->text();
        QVERIFY2(asked.contains(QStringLiteral("fixed.off")), qPrintable(asked));
        const QString known = question->findChild<QLabel*>(QStringLiteral("knownSizes"))->text();
        QVERIFY2(known.contains(QStringLiteral("190 mm")), qPrintable(known));
        // From the body's end at -50 mm to the pins' at 105 mm.
        QVERIFY2(known.contains(QStringLiteral("155 × 60 × 40 mm")), qPrintable(known));
        answerUnit(question, "mm");
      },
      QStringLiteral("unitDialog"));
  drop(d.window(), {d.vise, d.fixedFile});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{7});
  QVERIFY(isNear(widthOf(d.part("fixed")), 0.04, 1e-12));
  QVERIFY(isNear(widthOf(d.part("body 2")), 0.1, 1e-12));
}

/// Each mesh was added a second time beside the robot, after a question for its unit.
void DesktopDocumentsTest::aDroppedRobotBringsItsMeshesOnceAndNobodyAsksForTheirUnit() {
  DocumentDesk d;
  const std::filesystem::path robot = d.folder.path() / "robot";
  std::filesystem::create_directories(robot / "meshes");
  const QString arm = writeOff(robot / "meshes" / "arm.off", boxMesh(glm::dvec3(0.01)));
  d.folder.write("robot/robot.urdf",
                 R"(<robot name="r"><link name="l"><visual><geometry><mesh filename="meshes/arm.off"/>
</geometry></visual></link></robot>)");
  // The importer that stands in makes a vise of it. A question would hold it up.
  drop(d.window(), {nameOf(robot)});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  QTRY_VERIFY(!d.window().document().isBusy());
  QVERIFY(d.session().scene().findByName("arm") == nullptr);
  d.choose("undo");
  // Others beside it are added, and their unit is asked for.
  writeOff(robot / "table.off", boxMesh(glm::dvec3(0.04)));
  DialogAnswers answers;
  QString asked;
  answers.expect(QStringLiteral("unitDialog"), [&](QDialog& question) {
    asked = question.findChild<QLabel*>(QStringLiteral("unitQuestion"))->text();
    answerUnit(&question, "mm");
    return true;
  });
  drop(d.window(), {nameOf(robot)});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{4});
  QCOMPARE(answers.faults(), QStringList());
  QVERIFY2(asked.contains(QStringLiteral("table.off")) && !asked.contains(QStringLiteral("arm.off")),
           qPrintable(asked));
  QVERIFY(d.session().scene().findByName("table") != nullptr);
  QVERIFY(d.session().scene().findByName("arm") == nullptr);
  // A mesh that the user chooses by itself is wanted.
  QTRY_VERIFY(!d.window().document().isBusy());
  d.window().document().openFiles({nameOf(robot), arm}, 1e-3);
  QTRY_VERIFY(d.session().scene().findByName("arm") != nullptr);
}

/// Files were offered that are refused.
void DesktopDocumentsTest::compressedFilesAreOfferedWhereTheyAreRead() {
  DocumentDesk d;
  QString filter;
  DialogAnswers answers;
  answers.expect(QStringLiteral("file"), [&](QDialog& dialog) {
    filter = qobject_cast<QFileDialog*>(&dialog)->nameFilters().constFirst();
    dialog.reject();
    return true;
  });
  d.choose("addParts");
  QCOMPARE(answers.faults(), QStringList());
  for (const char* type : {"stl", "obj", "ply", "off", "step", "stp", "iges", "igs", "brep", "gltf", "urdf"})
    QVERIFY2(filter.contains(QStringLiteral(" *.%1.gz").arg(QLatin1String(type))), qPrintable(filter));
  for (const char* type : {"glb", "3mf"}) {
    QVERIFY2(filter.contains(QStringLiteral(" *.%1 ").arg(QLatin1String(type))), qPrintable(filter));
    QVERIFY2(!filter.contains(QStringLiteral("*.%1.gz").arg(QLatin1String(type))), qPrintable(filter));
  }
}

void DesktopDocumentsTest::itsUnitCannotBeChangedAndTheToolTipTellsTheReason() {
  DocumentDesk d;
  d.open();
  d.window().selection().select(d.partId("body"));
  QAction* change = d.action("changeUnit");
  QVERIFY(!change->isEnabled());
  QVERIFY2(change->toolTip().contains(QStringLiteral("stores its unit")), qPrintable(change->toolTip()));
}

/// It opened 200 m large, and nothing could be done about it.
void DesktopDocumentsTest::aGltfInMillimetresIsPointedOutAndCorrectedAsAWhole() {
  DesktopDriver d;
  const FakeImporter importer([](const Tessellation&) {
    CadDocument document;
    document.shapes = {boxShape("block", {100.0, 60.0, 40.0})};
    document.nodes = {instanceNode("near", -1, 0), instanceNode("far", -1, 0, {{1, 0, 0, 0}, {200.0, 0, 0}})};
    return document;
  });
  drop(d.window(), {nameOf(d.folder.write("blocks.glb", "in millimetres"))});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{2});
  QCOMPARE(widthOf(d.part("near")), 100.0);
  const auto offer = [&] {
    auto* notice = d.widget<QWidget>("notice-rescale");
    if (notice == nullptr || !notice->isVisible()) return QString();
    return notice->findChild<QPushButton*>(QStringLiteral("choice1"))->text().remove(QChar(','));
  };
  QTRY_COMPARE(offer(), QStringLiteral("Make 1000 times smaller"));
  // One part is selected; the document changes as a whole, so that it does not come apart.
  d.window().selection().select(d.partId("far"));
  whenModal<QDialog>([](QDialog* question) { answerUnit(question, "mm"); }, QStringLiteral("unitDialog"));
  d.choose("changeUnit");
  QTRY_VERIFY(isNear(widthOf(d.part("far")), 0.1, 1e-12));
  QVERIFY(isNear(widthOf(d.part("near")), 0.1, 1e-12));
  QVERIFY(isNear(d.part("far").worldFromPart.translation.x, 0.2, 1e-12));
  QTRY_COMPARE(offer(), QString());
  d.choose("undo");
  QCOMPARE(d.part("far").worldFromPart.translation.x, 200.0);
  QCOMPARE(widthOf(d.part("near")), 100.0);
}

/// Its unit could not be changed.
void DesktopDocumentsTest::a3mfThatStatesAWrongUnitIsCorrectedAsAWhole() {
  DesktopDriver d;
  // It states millimetres, and its numbers are in inches: 4 x 2 x 1 of them.
  const FakeImporter importer([](const Tessellation&) {
    CadDocument document;
    document.statedUnit = 1e-3;
    document.shapes = {boxShape("block", {4e-3, 2e-3, 1e-3})};
    document.nodes = {instanceNode("near", -1, 0), instanceNode("far", -1, 0, {{1, 0, 0, 0}, {0.01, 0, 0}})};
    return document;
  });
  drop(d.window(), {nameOf(d.folder.write("blocks.3mf", "in inches"))});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{2});
  QVERIFY(isNear(widthOf(d.part("near")), 4e-3, 1e-15));
  const std::size_t steps = d.session().historyIndex();
  d.window().selection().select(d.partId("far"));
  QVERIFY(d.action("changeUnit")->isEnabled());
  QString present, inMillimetres, inInches, known;
  DialogAnswers answers;
  answers.expect(QStringLiteral("unitDialog"), [&](QDialog& question) {
    for (const QRadioButton* choice : question.findChildren<QRadioButton*>()) {
      if (choice->isChecked()) present = choice->objectName();
    }
    inMillimetres = question.findChild<QLabel*>(QStringLiteral("size-mm"))->text();
    inInches = question.findChild<QLabel*>(QStringLiteral("size-in"))->text();
    known = question.findChild<QLabel*>(QStringLiteral("knownSizes"))->text();
    answerUnit(&question, "in");
    return true;
  });
  d.choose("changeUnit");
  QTRY_VERIFY(isNear(widthOf(d.part("far")), 0.1016, 1e-12));
  QCOMPARE(answers.faults(), QStringList());
  QCOMPARE(present, QStringLiteral("unit-mm"));
  // Both blocks where they are placed, 10 units apart.
  QCOMPARE(inMillimetres, QStringLiteral("14 × 2 × 1 mm"));
  QCOMPARE(inInches, QStringLiteral("355.6 × 50.8 × 25.4 mm"));
  QVERIFY2(!known.contains(QStringLiteral("scene")), "nothing else is there to compare with");
  QVERIFY2(isNear(widthOf(d.part("near")), 0.1016, 1e-12), "it changes as a whole");
  QVERIFY(isNear(d.part("far").worldFromPart.translation.x, 0.254, 1e-12));
  QCOMPARE(d.session().historyIndex(), steps + 1);
  // It is offered as the present one, and the scene keeps it.
  answers.expect(QStringLiteral("unitDialog"), [&](QDialog& question) {
    const auto* inch = question.findChild<QRadioButton*>(QStringLiteral("unit-in"));
    present = inch->isChecked() ? inch->text() : QString();
    question.reject();
    return true;
  });
  d.choose("changeUnit");
  QVERIFY2(present.contains(QStringLiteral("now")), qPrintable(present));
  const std::filesystem::path file = d.folder.path() / "blocks.nearfit";
  d.session().save(file);
  d.choose("undo");
  QVERIFY(isNear(widthOf(d.part("near")), 4e-3, 1e-15));
  QVERIFY(isNear(d.part("far").worldFromPart.translation.x, 0.01, 1e-15));
  d.session().reset();
  d.window().document().openScene(nameOf(file));
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{2});
  QVERIFY(isNear(widthOf(d.part("near")), 0.1016, 1e-12));
  QVERIFY(isNear(d.part("near").geometry->unitOfNumbers(), 0.0254, 1e-15));
}

/// Its triangles could be chosen once it was there, which read it twice.
void DesktopDocumentsTest::itHasTheTrianglesThatWereChosenBeforeItWasAdded() {
  DocumentDesk d;
  d.open();
  const std::size_t usual = d.trianglesOf("pin");
  QCOMPARE(d.part("pin").geometry->tessellation, Tessellation{});
  d.choose("undo");
  const std::size_t steps = d.session().historyIndex();
  const QString importTriangles = QStringLiteral("importTessellationDialog");
  DialogAnswers answers;
  answers.expect(importTriangles, triangles("0.001"));
  d.choose("importTriangles");
  QCOMPARE(d.session().historyIndex(), steps);
  QTRY_VERIFY(!d.window().document().isBusy());
  answers.expectFile(d.vise);
  d.choose("addParts");
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  QCOMPARE(answers.faults(), QStringList());
  const auto isFine = [&d, usual](const char* pin) {
    return isNear(d.part(pin).geometry->tessellation.chord, 1e-6, 1e-15) &&
           isNear(d.part(pin).geometry->effectiveTessellation.chord, 1e-6, 1e-15) &&
           d.trianglesOf(pin) > 4 * usual;
  };
  QVERIFY(isFine("pin") && isFine("pin 2"));
  QVERIFY(isNear(d.importer.asked().back().tessellation.chord, 1e-6, 1e-15));
  QCOMPARE(d.session().historyIndex(), steps + 1);
  d.choose("undo");
  QVERIFY(d.session().scene().parts().empty());
  d.choose("redo");
  QVERIFY(isFine("pin") && isFine("pin 2"));
  // The scene keeps it, whatever is chosen later.
  const std::filesystem::path file = d.folder.path() / "fine.nearfit";
  d.session().save(file);
  answers.expect(importTriangles, triangles(nullptr));
  d.choose("importTriangles");
  d.session().reset();
  d.window().document().openScene(nameOf(file));
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  QCOMPARE(answers.faults(), QStringList());
  QVERIFY(isFine("pin"));
}

void DesktopDocumentsTest::theChoiceOfTrianglesIsKeptAndCanBeTakenBack() {
  const QString importTriangles = QStringLiteral("importTessellationDialog");
  {
    DocumentDesk d;
    DialogAnswers answers;
    answers.expect(importTriangles, triangles("0.5"));
    d.choose("importTriangles");
    QCOMPARE(answers.faults(), QStringList());
  }
  // The program is started again.
  DocumentDesk d;
  DialogAnswers answers;
  double shown = 0.0;
  bool isAutomatic = true;
  answers.expect(importTriangles, [&](QDialog& dialog) {
    shown = dialog.findChild<ui::NumberField*>(QStringLiteral("refineChord"))->quantity();
    isAutomatic = dialog.findChild<QAbstractButton*>(QStringLiteral("refineAutomatic"))->isChecked();
    QTest::keyClick(&dialog, Qt::Key_Escape);
    return !dialog.isVisible();
  });
  d.choose("importTriangles");
  QVERIFY(!isAutomatic && isNear(shown, 5e-4, 1e-12));
  d.open();
  QVERIFY(isNear(d.part("pin").geometry->tessellation.chord, 5e-4, 1e-12));
  answers.expect(importTriangles, triangles(nullptr));
  d.choose("importTriangles");
  QCOMPARE(answers.faults(), QStringList());
  drop(d.window(), {d.vise});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{6});
  QCOMPARE(d.part("body 2").geometry->tessellation, Tessellation{});
  QVERIFY(isNear(d.part("body").geometry->tessellation.chord, 5e-4, 1e-12));
  // Someone has edited the settings.
  for (const Tessellation wrong : {Tessellation{-1.0, 0.0}, Tessellation{0.0, 7.0}}) {
    ui::setImportTessellation(wrong);
    QCOMPARE(ui::importTessellation(), Tessellation{});
  }
}

void DesktopDocumentsTest::trianglesOfTheCommandLineGoBeforeTheChoice() {
  const std::array given{"nearfit", "a.step", "--chord", "2e-5", "--angle", "6"};
  const auto options = std::get<desktop::Options>(parsedLine(given));
  QVERIFY(options.tessellation.has_value());
  QCOMPARE(options.tessellation->chord, 2e-5);
  QVERIFY(isNear(options.tessellation->angle, std::numbers::pi / 30.0, 1e-12));
  QVERIFY(!std::get<desktop::Options>(parsedLine(std::array{"nearfit", "a.step"})).tessellation);
  for (const char* option : {"--chord", "--angle"}) {
    const std::array wrong{"nearfit", "a.step", option, "-1"};
    QCOMPARE(std::get<int>(parsedLine(wrong)), desktop::kUsageExitCode);
    const std::array without{"nearfit", option, "1"};
    QCOMPARE(std::get<int>(parsedLine(without)), desktop::kUsageExitCode);
  }
  ui::setImportTessellation({5e-4, 0.2});
  DocumentDesk d;
  d.application.show({d.vise}, false, std::nullopt, options.tessellation);
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  QCOMPARE(d.part("pin").geometry->tessellation, *options.tessellation);
  QCOMPARE(ui::importTessellation(), (Tessellation{5e-4, 0.2}));
}

void DesktopDocumentsTest::anUnattendedRunDoesNotDependOnTheChoiceOfTriangles() {
  const std::array picture{"nearfit", "a.step", "--screenshot", "a.png"};
  const std::array timed{"nearfit", "a.step", "--device", "replay:a.csv", "--seconds", "1"};
  QCOMPARE(std::get<desktop::Options>(parsedLine(picture)).tessellation, std::optional(Tessellation{}));
  QCOMPARE(std::get<desktop::Options>(parsedLine(timed)).tessellation, std::optional(Tessellation{}));
}

void DesktopDocumentsTest::refiningAPartTakesItsInstancesAlongAndIsOneStep() {
  DocumentDesk d;
  d.open();
  const std::size_t coarse = d.trianglesOf("pin"), steps = d.session().historyIndex();
  const RigidTransform pose = d.part("pin").worldFromPart;
  d.window().selection().select(d.partId("pin 2"));
  whenModal<QDialog>(
      [&](QDialog* dialog) {
        const QString text = dialog->findChild<QLabel*>(QStringLiteral("refineText"))->text();
        QVERIFY2(text.contains(QLocale().toString(static_cast<qulonglong>(coarse))), qPrintable(text));
        auto* automatic = dialog->findChild<QAbstractButton*>(QStringLiteral("refineAutomatic"));
        auto* chord = dialog->findChild<ui::NumberField*>(QStringLiteral("refineChord"));
        QVERIFY(automatic->isChecked() && !chord->isEnabled());
        QVERIFY(isNear(chord->quantity(), 1e-4, 1e-9));
        automatic->setFocus();
        QTest::keyClick(automatic, Qt::Key_Space);
        QVERIFY(chord->isEnabled());
        chord->setFocus();
        chord->selectAll();
        QTest::keyClicks(chord, QStringLiteral("0.001"));
        keepPictures(*dialog, QStringLiteral("refine"));
        QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok),
                          Qt::LeftButton);
      },
      QStringLiteral("refineDialog"));
  d.choose("refine");
  QTRY_VERIFY(d.trianglesOf("pin") > 4 * coarse);
  QCOMPARE(d.part("pin").geometry, d.part("pin 2").geometry);
  QCOMPARE(d.session().historyIndex(), steps + 1);
  QCOMPARE(d.session().undoText(), std::string("Refine 2 parts"));
  QCOMPARE(d.part("pin").worldFromPart.translation, pose.translation);
  QVERIFY(isNear(d.part("pin").geometry->tessellation.chord, 1e-6, 1e-15));
  const auto number = [](std::size_t count) { return QLocale().toString(static_cast<qulonglong>(count)); };
  const auto said = [&d] { return d.window().statusBar()->currentMessage(); };
  const QString counts =
      QStringLiteral("%1 triangles instead of %2").arg(number(d.trianglesOf("pin")), number(coarse));
  QTRY_VERIFY2(said().contains(counts), qPrintable(said()));
  // The same values again.
  whenModal<QDialog>(
      [](QDialog* dialog) {
        QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok),
                          Qt::LeftButton);
      },
      QStringLiteral("refineDialog"));
  d.choose("refine");
  QTRY_COMPARE(said(), QStringLiteral("Nothing to refine: the values are as before"));
  QCOMPARE(d.session().historyIndex(), steps + 1);
  d.choose("undo");
  QCOMPARE(d.trianglesOf("pin"), coarse);
  d.choose("redo");
  QVERIFY(d.trianglesOf("pin") > 4 * coarse);
}

/// Its dialog was called "Loading".
void DesktopDocumentsTest::refiningSaysSoWithTheNameOfThePart() {
  DocumentDesk d;
  d.open();
  std::atomic<bool> mayEnd{false};
  const FakeImporter importer([&mayEnd](const Tessellation& tessellation) {
    while (!mayEnd)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return viseDocument(tessellation);
  });
  d.window().selection().select(d.partId("pin"));
  DialogAnswers answers;
  answers.expect(QStringLiteral("refineDialog"), [](QDialog& dialog) {
    QTest::mouseClick(dialog.findChild<QPushButton*>(QStringLiteral("refineFiner")), Qt::LeftButton);
    QTest::mouseClick(dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok), Qt::LeftButton);
    return !dialog.isVisible();
  });
  d.choose("refine");
  const auto* progress = d.widget<QDialog>("progressDialog");
  const QString title = progress != nullptr ? progress->windowTitle() : QString();
  QStringList texts;
  for (const QLabel* label : progress != nullptr ? progress->findChildren<QLabel*>() : QList<QLabel*>())
    texts << label->text();
  mayEnd = true;
  QTRY_VERIFY(!d.window().document().isBusy());
  QCOMPARE(answers.faults(), QStringList());
  QCOMPARE(title, QStringLiteral("Refining"));
  QVERIFY2(texts.contains(QStringLiteral("Refining pin and pin 2")), qPrintable(texts.join('\n')));
}

void DesktopDocumentsTest::finerAndCoarserScaleTheTolerances() {
  DocumentDesk d;
  d.open();
  d.window().selection().select(d.partId("pin"));
  whenModal<QDialog>(
      [](QDialog* dialog) {
        auto* chord = dialog->findChild<ui::NumberField*>(QStringLiteral("refineChord"));
        auto* angle = dialog->findChild<ui::NumberField*>(QStringLiteral("refineAngle"));
        const double before = chord->quantity(), turn = angle->quantity();
        QTest::mouseClick(dialog->findChild<QPushButton*>(QStringLiteral("refineFiner")), Qt::LeftButton);
        QVERIFY(isNear(chord->quantity(), before / 2.0, 1e-12));
        QVERIFY(isNear(angle->quantity(), turn / std::sqrt(2.0), 1e-9));
        QVERIFY(chord->isEnabled());
        QTest::mouseClick(dialog->findChild<QPushButton*>(QStringLiteral("refineCoarser")), Qt::LeftButton);
        QVERIFY(isNear(chord->quantity(), before, 1e-12));
        dialog->reject();
      },
      QStringLiteral("refineDialog"));
  d.choose("refine");
  QCOMPARE(d.session().historyIndex(), std::size_t{1});
}

void DesktopDocumentsTest::meshesCannotBeRefined() {
  DocumentDesk d;
  d.open();
  d.add({d.fixedFile});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{4});
  QAction* refine = d.action("refine");
  d.window().selection().select(d.partId("pin"));
  QVERIFY(refine->isEnabled());
  d.window().selection().set({d.partId("pin"), d.partId("fixed")});
  QVERIFY(!refine->isEnabled());
  d.window().selection().select(d.partId("pin"));
  d.session().setLocked(d.partId("pin"), true);
  QVERIFY(!refine->isEnabled());
}

void DesktopDocumentsTest::aSavedSceneComesBack() {
  DocumentDesk d;
  d.open();
  const std::filesystem::path file = d.folder.path() / "fit.nearfit";
  d.session().save(file);
  const std::size_t triangles = d.trianglesOf("pin");
  d.session().reset();
  d.window().document().openScene(nameOf(file));
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  QCOMPARE(d.trianglesOf("pin"), triangles);
  QCOMPARE(d.part("pin").geometry, d.part("pin 2").geometry);
  QVERIFY(!d.session().isModified());
}

void DesktopDocumentsTest::aChangedDocumentIsReloadedInPlace() {
  // From the second run on, the body is 20 mm longer and the pin is gone.
  const auto isChanged = std::make_shared<std::atomic<bool>>(false);
  DocumentDesk d;
  const FakeImporter importer([isChanged](const Tessellation& tessellation) {
    CadDocument document = viseDocument(tessellation);
    if (*isChanged) {
      document.shapes[0] = boxShape("body", {0.12, 0.06, 0.04});
      document.shapes[1].key = "bolt";
    }
    return document;
  });
  d.open();
  QStringList told;
  d.window().setFailureSink([&](const ui::Failure& failure) { told << failure.details; });
  const std::size_t steps = d.session().historyIndex(), pins = d.trianglesOf("pin");
  *isChanged = true;
  d.folder.write("vise.step", "the vise, changed");
  d.choose("reloadParts");
  QTRY_VERIFY(isNear(widthOf(d.part("body")), 0.12, 1e-12));
  QCOMPARE(d.session().historyIndex(), steps + 1);
  QCOMPARE(d.trianglesOf("pin"), pins);
  QTRY_COMPARE(told.size(), 1);
  QVERIFY2(told[0].contains(QStringLiteral("no shape")), qPrintable(told[0]));
}

void DesktopDocumentsTest::aChangedCompanionIsOfferedAndReloaded() {
  DesktopDriver d;
  const std::filesystem::path buffer = d.folder.write("block.bin", "0.1");
  const FakeImporter importer([buffer](const Tessellation&) {
    double width = 0.0;
    std::ifstream(buffer) >> width;
    CadDocument document;
    document.shapes = {boxShape("block", {width, 0.06, 0.04})};
    document.nodes = {instanceNode("block", -1, 0)};
    document.companions = {{"block.bin", sha256OfFile(buffer)}};
    return document;
  });
  drop(d.window(), {nameOf(d.folder.write("block.gltf", "{}"))});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{1});
  d.folder.write("block.bin", "0.25");
  const auto offered = [&]() -> QPushButton* {
    auto* notice = d.widget<QWidget>("notice-reload");
    return notice != nullptr && notice->isVisible()
               ? notice->findChild<QPushButton*>(QStringLiteral("choice1"))
               : nullptr;
  };
  QTRY_VERIFY_WITH_TIMEOUT(offered() != nullptr, 20'000);
  QTest::mouseClick(offered(), Qt::LeftButton);
  QTRY_VERIFY(isNear(widthOf(d.part("block")), 0.25, 1e-12));
  QCOMPARE(importer.runs(), 2);
}

void DesktopDocumentsTest::aDocumentThatFailsIsToldAndTheOthersAreAdded() {
  DocumentDesk d;
  const FakeImporter importer([](const Tessellation& tessellation) -> CadDocument {
    static std::atomic<int> runs{0};
    if (runs++ == 0) throw FileError("bad.step", "it ends within an entity", "export it again");
    return viseDocument(tessellation);
  });
  QStringList told;
  d.window().setFailureSink(
      [&](const ui::Failure& failure) { told << failure.summary + QChar('\n') + failure.details; });
  const QString bad = nameOf(d.folder.write("bad.step", "no vise"));
  drop(d.window(), {bad, d.vise});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  QTRY_COMPARE(told.size(), 1);
  // What, what became of the others, why and what to do.
  QVERIFY2(told[0].startsWith(
               QStringLiteral("“bad.step”, one of 2 files, could not be loaded. The others were added.\n")),
           qPrintable(told[0]));
  QVERIFY2(told[0].contains(QStringLiteral("ends within an entity")), qPrintable(told[0]));
  QVERIFY2(told[0].contains(QStringLiteral("xport it again")), qPrintable(told[0]));
}

void DesktopDocumentsTest::openReplacesTheSceneByThatOfADocumentUnlessItCannotBeRead() {
  DocumentDesk d;
  QStringList told;
  d.window().setFailureSink([&](const ui::Failure& failure) { told << failure.summary; });
  d.addCubes();
  d.session().save(d.folder.path() / "pair.nearfit");
  const QString bad = nameOf(d.folder.write("bad.step", "no vise"));
  DialogAnswers answers;
  {
    const FakeImporter importer([](const Tessellation&) -> CadDocument {
      throw FileError("bad.step", "it ends within an entity", "export it again");
    });
    pressOpen(d, answers, bad);
    QTRY_COMPARE(told.size(), 1);
    QTRY_VERIFY(!d.window().document().isBusy());
  }
  QCOMPARE(told.first(), QStringLiteral("“bad.step” could not be loaded. The open scene stays."));
  QCOMPARE(d.session().scene().parts().size(), std::size_t{2});
  QCOMPARE(d.session().file(), d.folder.path() / "pair.nearfit");
  QVERIFY(!d.session().isModified());
  pressOpen(d, answers, d.vise);
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  QCOMPARE(answers.faults(), QStringList());
  QCOMPARE(d.part("pin 2").worldFromPart.translation, glm::dvec3(0.1, 0.02, 0.0));
  QCOMPARE(d.session().scene().groups().size(), std::size_t{2});
  QVERIFY(d.session().file().empty() && d.session().isModified());
  QCOMPARE(told.size(), 1);
}

NEARFIT_QT_SUITE(DesktopDocumentsTest, runDesktopTest<DesktopDocumentsTest>)
#include "desktop_documents_test.moc"
