// Selecting by a box in the view: what is seen in it, with the keys that clicks have, in each mode.
#include <QLabel>
#include <QRubberBand>

#include "tests/app/desktop/view_pointer.h"
#include "ui/model/selection.h"

using namespace nearfit;
using namespace nearfit::test;

using Parts = std::vector<PartId>;

namespace {

/// Three cubes of 40 mm side by side along x, seen from above.
struct Row {
  Row() : pointer(d) {
    d.add({d.fixedFile, d.fixedFile, d.fixedFile});
    (void)QTest::qWaitFor([&] { return d.session().scene().parts().size() == 3; });
    for (const Scene::PartPtr& part : d.session().scene().parts())
      ids.push_back(part->id);
    d.session().movePart(ids[0], {{1, 0, 0, 0}, {-0.1, 0, 0}});
    d.session().movePart(ids[2], {{1, 0, 0, 0}, {0.1, 0, 0}});
    selection().select(std::nullopt);
    d.choose("viewTop");
    d.window().viewport().setFocus();
  }
  ui::Selection& selection() { return d.window().selection(); }
  void pressB() {
    pressInView(d, Qt::Key_B);
    QVERIFY(d.action("boxSelect")->isChecked());
  }
  /// From one place to another, both at the height of the cubes' upper faces.
  void box(const glm::dvec2& from, const glm::dvec2& to, Qt::KeyboardModifiers keys = {}) {
    pressB();
    const QPoint begin = pointer.seen({from, 0.02});
    pointer.drag(begin, pointer.seen({to, 0.02}) - begin, keys);
  }
  QRubberBand* band() { return d.widget<QRubberBand>("selectionBox"); }
  glm::dvec3 away() { return d.window().viewport().projection().away(); }

  DesktopDriver d;
  ViewPointer pointer;
  Parts ids;
};

}  // namespace

class DesktopBoxSelectTest : public QObject {
  Q_OBJECT

 private slots:
  void whatIsSeenInTheBoxIsSelectedAndTheNextDragOrbits();
  void shiftAddsAndControlAddsOrTakesOut();
  void whatIsHiddenIsNotSelected();
  void handlesAndPartsUnderTheBoxAreNotDragged();
  void otherToolsStayOn();
  void escapeAndAnotherButtonLeaveEverythingAsItWas();
  void withoutADragItIsAClick();
};

void DesktopBoxSelectTest::whatIsSeenInTheBoxIsSelectedAndTheNextDragOrbits() {
  Row r;
  const glm::dvec3 before = r.away();
  // The corner of the first, and all of the second.
  r.box({-0.09, -0.05}, {0.05, 0.05});
  QVERIFY(r.selection().parts() == (Parts{r.ids[0], r.ids[1]}));
  QVERIFY(!r.d.action("boxSelect")->isChecked());
  QVERIFY(!r.band()->isVisible());
  QVERIFY(glm::distance(r.away(), before) == 0.0);
  // From the right to the left it is the same; on empty ground nothing is.
  r.box({0.13, 0.05}, {0.09, -0.05});
  QVERIFY(r.selection().parts() == Parts{r.ids[2]});
  r.box({-0.13, 0.03}, {0.13, 0.04});
  QVERIFY(r.selection().isEmpty());
  r.pointer.drag(r.pointer.seen({-0.05, 0.04, 0.02}), QPoint(60, 20));
  QVERIFY(glm::distance(r.away(), before) > 0.05);
  QVERIFY(r.selection().isEmpty());
}

void DesktopBoxSelectTest::shiftAddsAndControlAddsOrTakesOut() {
  Row r;
  r.selection().select(r.ids[2]);
  r.box({-0.13, -0.05}, {-0.05, 0.05}, Qt::ShiftModifier);
  QVERIFY(r.selection().parts() == (Parts{r.ids[2], r.ids[0]}));
  r.box({-0.05, -0.05}, {0.13, 0.05}, Qt::ControlModifier);
  QVERIFY(r.selection().parts() == (Parts{r.ids[0], r.ids[1]}));
  // Where there is nothing, nothing is lost.
  r.box({-0.05, 0.03}, {0.05, 0.04}, Qt::ShiftModifier);
  r.box({-0.05, 0.03}, {0.05, 0.04}, Qt::ControlModifier);
  QVERIFY(r.selection().parts() == (Parts{r.ids[0], r.ids[1]}));
}

void DesktopBoxSelectTest::whatIsHiddenIsNotSelected() {
  Row r;
  // Below the second, and as wide.
  r.d.session().movePart(r.ids[2], {{1, 0, 0, 0}, {0, 0, -0.1}});
  r.box({-0.015, -0.015}, {0.015, 0.015});
  QVERIFY(r.selection().parts() == Parts{r.ids[1]});
  r.d.session().setVisible(r.ids[1], false);
  r.box({-0.015, -0.015}, {0.015, 0.015});
  QVERIFY(r.selection().parts() == Parts{r.ids[2]});
  // Seen through another it is selected with it.
  r.d.session().setVisible(r.ids[1], true);
  r.d.session().setOpacity({r.ids[1]}, 0.5);
  r.box({-0.015, -0.015}, {0.015, 0.015});
  QVERIFY(r.selection().parts() == (Parts{r.ids[1], r.ids[2]}));
}

void DesktopBoxSelectTest::handlesAndPartsUnderTheBoxAreNotDragged() {
  Row r;
  r.selection().select(r.ids[1]);
  r.d.choose("gizmoMoveAndTurn");
  QTRY_VERIFY(r.pointer.overlay().picture().has_value());
  const std::string undo = r.d.session().undoText();
  const QPoint middle = r.pointer.seen({0.0, 0.0, 0.02});
  r.pressB();
  r.pointer.drag(middle, r.pointer.seen({0.13, 0.05, 0.02}) - middle);
  QVERIFY(r.selection().parts() == (Parts{r.ids[1], r.ids[2]}));
  QCOMPARE(r.d.session().undoText(), undo);
}

void DesktopBoxSelectTest::otherToolsStayOn() {
  for (const char* tool : {"align", "measure"}) {
    Row r;
    r.d.choose(tool);
    QVERIFY(r.d.action(tool)->isChecked());
    r.box({-0.13, -0.05}, {-0.05, 0.05});
    QVERIFY(r.selection().parts() == Parts{r.ids[0]});
    QVERIFY(r.d.action(tool)->isChecked());
    // Escape ends what was begun last.
    r.pressB();
    pressInView(r.d, Qt::Key_Escape);
    QVERIFY(!r.d.action("boxSelect")->isChecked());
    QVERIFY(r.d.action(tool)->isChecked());
    pressInView(r.d, Qt::Key_Escape);
    QVERIFY(!r.d.action(tool)->isChecked());
  }
}

void DesktopBoxSelectTest::escapeAndAnotherButtonLeaveEverythingAsItWas() {
  Row r;
  r.selection().select(r.ids[2]);
  const QPoint from = r.pointer.seen({-0.13, -0.05, 0.02}), to = r.pointer.seen({0.05, 0.05, 0.02});
  const glm::dvec3 before = r.away();
  r.pressB();
  r.pointer.press(from);
  r.pointer.moveTo(to);
  QVERIFY(r.band()->isVisible());
  QCOMPARE(r.band()->geometry(), QRect(from, to).normalized());
  keepPictures(r.d.window(), QStringLiteral("box-select"));
  pressInView(r.d, Qt::Key_Escape);
  QVERIFY(!r.band()->isVisible());
  // The rest of the drag is nobody's.
  r.pointer.moveTo(from);
  r.pointer.release(from);
  QVERIFY(r.selection().parts() == Parts{r.ids[2]});
  QVERIFY(glm::distance(r.away(), before) == 0.0);
  // By the key of the tool, too.
  r.pressB();
  pressInView(r.d, Qt::Key_B);
  QVERIFY(!r.d.action("boxSelect")->isChecked());
  r.pointer.drag(from, QPoint(60, 30));
  QVERIFY(glm::distance(r.away(), before) > 0.05);
}

void DesktopBoxSelectTest::withoutADragItIsAClick() {
  Row r;
  r.pressB();
  QTest::mouseClick(&r.d.window().viewport(), Qt::LeftButton, {}, r.pointer.seen({0.1, 0.0, 0.02}));
  QVERIFY(r.selection().parts() == Parts{r.ids[2]});
  r.pressB();
  QTest::mouseClick(&r.d.window().viewport(), Qt::LeftButton, Qt::ControlModifier,
                    r.pointer.seen({0.0, 0.0, 0.02}));
  QVERIFY(r.selection().parts() == (Parts{r.ids[2], r.ids[1]}));
  QVERIFY(!r.d.action("boxSelect")->isChecked());
}

NEARFIT_QT_SUITE(DesktopBoxSelectTest, runDesktopTest<DesktopBoxSelectTest>)
#include "desktop_box_select_test.moc"
