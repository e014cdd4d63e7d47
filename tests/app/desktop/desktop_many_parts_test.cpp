#include <QDoubleSpinBox>

#include "tests/app/desktop/export_driver.h"
#include "tests/app/desktop/view_pointer.h"
#include "tests/ui/view3d/picture_comparison.h"
#include "ui/model/parts_model.h"
#include "ui/model/selection.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

constexpr int kSide = 10, kCount = kSide * kSide * kSide;
constexpr double kSpacing = 0.06;  ///< From cube to cube, of 40 mm each [m].

/// A thousand cubes of one file, ten each way, in a scene file.
std::filesystem::path thousandParts(const DesktopDriver& d) {
  Session session;
  const PartGeometryPtr cube = loadPartGeometry(d.fixedFile.toStdString(), 1e-3);
  session.addParts(std::vector<Session::NewPart>(kCount, {cube, "cube"}));
  const std::vector<Scene::PartPtr> parts = session.scene().parts();
  for (int i = 0; i < kCount; ++i) {
    const glm::dvec3 place(i % kSide, i / kSide % kSide, i / kSide / kSide);
    session.movePart(parts[static_cast<std::size_t>(i)]->id, {{1, 0, 0, 0}, kSpacing * place});
  }
  const auto file = d.folder.path() / "thousand.nearfit";
  session.save(file);
  return file;
}

struct Thousand : DesktopDriver {
  Thousand() {
    const QString file = QString::fromStdString(thousandParts(*this).string());
    whenModal<QFileDialog>([file](QFileDialog* dialog) { chooseFile(dialog, file); });
    choose("open");
    (void)QTest::qWaitFor([&] { return session().scene().parts().size() == std::size_t(kCount); }, 30'000);
  }
  ui::Selection& selection() { return window().selection(); }
  const Part& part(int x, int y, int z) {
    return *session().scene().parts().at(
        static_cast<std::size_t>(x) +
        kSide * (static_cast<std::size_t>(y) + kSide * static_cast<std::size_t>(z)));
  }
};

}  // namespace

/// What an engineer does with a scene of a thousand parts; how long it takes is nearfit-bench-window's.
class DesktopManyPartsTest : public QObject {
  Q_OBJECT

 private slots:
  void oneOfAThousandIsPickedInTheViewAndShownInTheTree();
  void allAreMovedAsOneAndOneByOne();
  void mostAreHiddenAndComeBack();
  void thePartInHandMeetsItsNeighboursAlone();
};

void DesktopManyPartsTest::oneOfAThousandIsPickedInTheViewAndShownInTheTree() {
  Thousand d;
  QCOMPARE(d.session().scene().parts().size(), std::size_t(kCount));
  ViewPointer pointer(d);
  pointer.look("viewFront");
  // From the front, those of the first row along y are seen.
  for (const auto& [x, z] : {std::pair(0, 0), std::pair(8, 8), std::pair(3, 7)}) {
    const Part& wanted = d.part(x, 0, z);
    pointer.click(wanted.worldFromPart.applyToPoint({0.003, -0.02, 0.004}));
    QVERIFY(d.selection().parts() == std::vector{wanted.id});
    QTreeView* tree = d.partsView();
    const QModelIndexList rows = tree->selectionModel()->selectedRows();
    QCOMPARE(rows.size(), 1);
    QCOMPARE(rows.first().data().toString(), QString::fromStdString(wanted.name));
    QVERIFY(tree->viewport()->rect().contains(tree->visualRect(rows.first()).center()));
  }
}

void DesktopManyPartsTest::allAreMovedAsOneAndOneByOne() {
  Thousand d;
  const std::size_t steps = d.session().historyIndex();
  d.choose("selectAll");
  QCOMPARE(d.selection().parts().size(), std::size_t(kCount));
  // Qt compares each range of rows with each: neighbours are one.
  QCOMPARE(d.partsView()->selectionModel()->selection().size(), 1);
  d.type<QDoubleSpinBox>("positionX", "+= 10 mm");
  QCOMPARE(d.session().historyIndex(), steps + 1);
  QVERIFY(std::abs(d.part(4, 5, 6).worldFromPart.translation.x - (4 * kSpacing + 0.01)) < 1e-12);
  ViewPointer pointer(d);
  pointer.look("viewFront");
  const Part& corner = d.part(8, 0, 8);
  pointer.click(corner.worldFromPart.applyToPoint({0.003, -0.02, 0.004}));
  const double before = corner.worldFromPart.translation.z;
  pointer.drag(pointer.handle(GizmoGrip::MoveZ), {0, -40});
  QVERIFY(d.part(8, 0, 8).worldFromPart.translation.z > before + 1e-3);
  QCOMPARE(d.session().historyIndex(), steps + 2);
  d.choose("undo");
  d.choose("undo");
  QCOMPARE(d.part(4, 5, 6).worldFromPart.translation.x, 4 * kSpacing);
  QCOMPARE(d.part(8, 0, 8).worldFromPart.translation.z, before);
}

void DesktopManyPartsTest::mostAreHiddenAndComeBack() {
  Thousand d;
  ViewPointer pointer(d);
  pointer.look("viewFront");
  const QImage all = d.picture();
  const Part& kept = d.part(5, 0, 5);
  pointer.click(kept.worldFromPart.applyToPoint({0.003, -0.02, 0.004}));
  d.choose("isolate");
  const auto visible = [&] {
    return std::ranges::count_if(d.session().scene().parts(),
                                 [](const Scene::PartPtr& part) { return part->isVisible; });
  };
  QCOMPARE(visible(), 1);
  // Where another stood, a click finds nothing now.
  pointer.click(d.part(7, 0, 7).worldFromPart.applyToPoint({0.003, -0.02, 0.004}));
  QVERIFY(d.selection().isEmpty());
  d.choose("endIsolation");
  QCOMPARE(visible(), kCount);
  // What is kept of the depths may be of another range.
  QVERIFY(!compare(d.picture(), all).isSeen());
}

void DesktopManyPartsTest::thePartInHandMeetsItsNeighboursAlone() {
  Thousand d;
  const PartId middle = d.part(5, 5, 5).id;
  d.selection().select(middle);
  d.choose("takeInHand");
  QVERIFY(d.session().scene().movingPart() == middle);
  d.startWith(ui::Hand::Manual);
  // Nothing is within the cutoff of 10 mm until it goes to the one above.
  QTRY_COMPARE_WITH_TIMEOUT(d.text("statusMinima"), QStringLiteral("Minima 0"), 30'000);
  d.type<QDoubleSpinBox>("positionZ", "+= 15 mm");
  QTRY_COMPARE(d.text("statusDistance"), QStringLiteral("Min distance 5.00 mm"));
  d.type<QDoubleSpinBox>("positionZ", "+= 15 mm");
  // It is held a margin before the face.
  QTRY_VERIFY(d.felt && std::abs(d.felt->translation.z - (5 * kSpacing + 0.02 - 1e-4)) < 2e-5);
  d.choose("stop");
  QTRY_COMPARE(QString::fromStdString(d.session().undoText()),
               QStringLiteral("Feel ") + QString::fromStdString(d.part(5, 5, 5).name));
}

NEARFIT_QT_SUITE(DesktopManyPartsTest, runDesktopTest<DesktopManyPartsTest>)
#include "desktop_many_parts_test.moc"
