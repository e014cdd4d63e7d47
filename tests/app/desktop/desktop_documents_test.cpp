// CAD documents in the window, made by an importer that stands in for the program that reads them.
#include <QAction>
#include <QPushButton>
#include <QStatusBar>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>

#include "core/files/sha256.h"
#include "core/scene/scene_tree.h"
#include "tests/app/desktop/file_drop.h"
#include "tests/support/documents.h"
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

}  // namespace

class DesktopDocumentsTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void aDroppedDocumentKeepsItsTreeAndIsOneStep();
  void itsUnitIsNotAskedFor();
  void filesWithoutAUnitBesideItAreAskedAboutWithKnownSizes();
  void itsUnitCannotBeChangedAndTheToolTipTellsTheReason();
  void aGltfInMillimetresIsPointedOutAndCorrectedAsAWhole();
  void refiningAPartTakesItsInstancesAlongAndIsOneStep();
  void finerAndCoarserScaleTheTolerances();
  void meshesCannotBeRefined();
  void aSavedSceneComesBack();
  void aChangedDocumentIsReloadedInPlace();
  void aChangedCompanionIsOfferedAndReloaded();
  void aDocumentThatFailsIsToldAndTheOthersAreAdded();
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
  d.choose("undo");
  QCOMPARE(d.trianglesOf("pin"), coarse);
  d.choose("redo");
  QVERIFY(d.trianglesOf("pin") > 4 * coarse);
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
        QVERIFY(isNear(chord->quantity(), before / 4.0, 1e-12));
        QVERIFY(isNear(angle->quantity(), turn / 2.0, 1e-9));
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
  d.window().setFailureSink([&](const ui::Failure& failure) { told << failure.details; });
  const QString bad = nameOf(d.folder.write("bad.step", "no vise"));
  drop(d.window(), {bad, d.vise});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  QTRY_COMPARE(told.size(), 1);
  QVERIFY2(told[0].contains(QStringLiteral("ends within an entity")), qPrintable(told[0]));
}

NEARFIT_QT_SUITE(DesktopDocumentsTest, runDesktopTest<DesktopDocumentsTest>)
#include "desktop_documents_test.moc"
