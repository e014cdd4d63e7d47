#include "tests/app/desktop/desktop_driver.h"
#include "ui/model/parts_model.h"
#include "ui/model/selection.h"

using namespace nearfit;
using namespace nearfit::test;

using Parts = std::vector<PartId>;

/// Three cubes side by side along x, seen from above with their middles at known places of the view.
class Row : public DesktopDriver {
 public:
  Row() {
    add({fixedFile, fixedFile, fixedFile});
    const Scene& scene = session().scene();
    (void)QTest::qWaitFor([&] { return scene.parts().size() == 3; });
    for (const Scene::PartPtr& part : scene.parts())
      ids.push_back(part->id);
    session().movePart(ids[0], {{1, 0, 0, 0}, {-0.1, 0, 0}});
    session().movePart(ids[2], {{1, 0, 0, 0}, {0.1, 0, 0}});
    choose("viewTop");
    selection().select(std::nullopt);
    QTest::qWait(100);
  }
  ui::Selection& selection() { return window().selection(); }
  /// A place of the view where a cube is: 0 on the left, 1 in the middle, 2 on the right. Found by clicks.
  QPoint middleOf(int cube) {
    ui::Viewport& view = window().viewport();
    const QPoint middle = view.rect().center();
    if (cube == 1) return middle;
    for (int x = 8; x < view.width() / 2; x += 8) {
      const QPoint place = middle + QPoint(cube == 0 ? -x : x, 0);
      selection().select(std::nullopt);
      QTest::mouseClick(&view, Qt::LeftButton, {}, place);
      if (selection().current() == ids[static_cast<std::size_t>(cube)]) {
        selection().select(std::nullopt);
        return place + QPoint(cube == 0 ? -8 : 8, 0);
      }
    }
    return {};
  }
  void click(int cube, Qt::KeyboardModifiers modifiers = {}) {
    const QPoint place = middleOf_[static_cast<std::size_t>(cube)];
    QTest::mouseClick(&window().viewport(), Qt::LeftButton, modifiers, place);
  }
  void findCubes() { middleOf_ = {middleOf(0), middleOf(1), middleOf(2)}; }
  void clickRow(int row, Qt::KeyboardModifiers modifiers) {
    QTreeView* view = partsView();
    QTest::mouseClick(view->viewport(), Qt::LeftButton, modifiers,
                      view->visualRect(view->model()->index(row, ui::PartsModel::Name)).center());
  }
  QList<int> rows() {
    QList<int> result;
    for (const QModelIndex& index : partsView()->selectionModel()->selectedRows())
      result << index.row();
    std::sort(result.begin(), result.end());
    return result;
  }

  Parts ids;

 private:
  std::array<QPoint, 3> middleOf_;
};

class DesktopSelectionTest : public QObject {
  Q_OBJECT

 private slots:
  void controlAndShiftClicksInTheListSelectSeveral();
  void controlAndShiftClicksInTheViewSelectSeveral();
  void allAndNoneByKeys();
  void shiftAndArrowInTheListTakeTheNextOneToo();
  void deletingOneKeepsTheOthersSelected();
};

void DesktopSelectionTest::controlAndShiftClicksInTheListSelectSeveral() {
  Row d;
  d.clickRow(2, {});
  d.clickRow(0, Qt::ControlModifier);
  QVERIFY(d.selection().parts() == (Parts{d.ids[2], d.ids[0]}));
  d.clickRow(2, Qt::ControlModifier);
  QVERIFY(d.selection().parts() == Parts{d.ids[0]});
  d.clickRow(0, {});
  d.clickRow(2, Qt::ShiftModifier);
  QVERIFY(d.selection().parts() == (Parts{d.ids[0], d.ids[1], d.ids[2]}));
  QVERIFY(d.text("poseHeading").contains(QString::fromStdString(d.session().scene().parts()[2]->name)));
}

void DesktopSelectionTest::controlAndShiftClicksInTheViewSelectSeveral() {
  Row d;
  d.findCubes();
  d.click(0);
  d.click(2, Qt::ControlModifier);
  QVERIFY(d.selection().parts() == (Parts{d.ids[0], d.ids[2]}));
  QCOMPARE(d.rows(), (QList<int>{0, 2}));
  d.click(1, Qt::ShiftModifier);
  QCOMPARE(d.rows(), (QList<int>{0, 1, 2}));
  QVERIFY(d.selection().current() == d.ids[1]);
  d.click(0, Qt::ControlModifier);
  QCOMPARE(d.rows(), (QList<int>{1, 2}));
  // Beside all parts: with a key held nothing is lost.
  QTest::mouseClick(&d.window().viewport(), Qt::LeftButton, Qt::ControlModifier, QPoint(5, 60));
  QCOMPARE(d.rows(), (QList<int>{1, 2}));
  QTest::mouseClick(&d.window().viewport(), Qt::LeftButton, {}, QPoint(5, 60));
  QVERIFY(d.rows().isEmpty() && d.selection().isEmpty());
}

void DesktopSelectionTest::allAndNoneByKeys() {
  Row d;
  d.session().setVisible(d.ids[1], false);
  d.window().viewport().setFocus();
  pressInView(d, Qt::Key_A, Qt::ControlModifier);
  QCOMPARE(d.rows(), (QList<int>{0, 2}));
  pressShortcut(d, Qt::Key_A, Qt::ControlModifier | Qt::ShiftModifier);
  QVERIFY(d.selection().isEmpty() && d.rows().isEmpty());
}

void DesktopSelectionTest::shiftAndArrowInTheListTakeTheNextOneToo() {
  Row d;
  d.clickRow(0, {});
  QTest::keyClick(d.partsView(), Qt::Key_Down, Qt::ShiftModifier);
  QVERIFY(d.selection().parts() == (Parts{d.ids[0], d.ids[1]}));
  QTest::keyClick(d.partsView(), Qt::Key_Down);
  QVERIFY(d.selection().parts() == Parts{d.ids[2]});
}

void DesktopSelectionTest::deletingOneKeepsTheOthersSelected() {
  Row d;
  d.selection().set(d.ids);
  d.session().deletePart(d.ids[1]);
  QVERIFY(d.selection().parts() == (Parts{d.ids[0], d.ids[2]}));
  QCOMPARE(d.rows(), (QList<int>{0, 1}));
}

NEARFIT_QT_SUITE(DesktopSelectionTest, runDesktopTest<DesktopSelectionTest>)
#include "desktop_selection_test.moc"
