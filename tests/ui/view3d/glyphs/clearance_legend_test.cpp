#include "ui/view3d/glyphs/clearance_legend.h"

#include <QtTest>

#include "tests/support/qt/qt_suite.h"
#include "ui/view3d/glyphs/colour_legend.h"

using namespace nearfit;

namespace {

/// Both legends over a view.
struct Legends {
  Legends() {
    view.resize(900, 700);
    ui::ClearanceLegend::Scale scale;
    scale.range = 1e-3;
    map.showScale(scale);
    glyphs.hide();
    view.show();
  }
  bool areApart() const { return !map.geometry().intersects(glyphs.geometry()); }
  bool areInView() const {
    return view.rect().contains(map.geometry()) && view.rect().contains(glyphs.geometry());
  }

  QWidget view;
  ui::ColourLegend glyphs{&view};
  ui::ClearanceLegend map{&view};
};

}  // namespace

class ClearanceLegendTest : public QObject {
  Q_OBJECT

 private slots:
  void givesWayToTheOtherLegend();
  void isBesideItWhereThereIsNoRoomBelow();
  void comesBackWhereTheOtherIsHidden();
};

void ClearanceLegendTest::givesWayToTheOtherLegend() {
  Legends l;
  const QPoint usual = l.map.pos();
  l.glyphs.show();
  for (const QPoint& at : {QPoint(14, 14), QPoint(60, 40), QPoint(14, 200)}) {
    l.glyphs.move(at);
    QTRY_VERIFY(l.areApart() && l.areInView());
  }
  l.glyphs.move(600, 500);
  QTRY_COMPARE(l.map.pos(), usual);
  // Also if it is shown later.
  l.map.hide();
  l.glyphs.move(14, 14);
  l.map.showScale({});
  QTRY_VERIFY(l.areApart() && l.areInView());
}

void ClearanceLegendTest::isBesideItWhereThereIsNoRoomBelow() {
  Legends l;
  l.glyphs.show();
  l.view.resize(900, l.map.height() + 60);
  l.glyphs.move(14, 14);
  QTRY_VERIFY(l.areApart() && l.areInView());
  QVERIFY(l.map.x() > l.glyphs.geometry().right());
}

void ClearanceLegendTest::comesBackWhereTheOtherIsHidden() {
  Legends l;
  const QPoint usual = l.map.pos();
  l.glyphs.show();
  l.glyphs.move(14, 14);
  QTRY_VERIFY(l.map.pos() != usual);
  l.glyphs.hide();
  QTRY_COMPARE(l.map.pos(), usual);
}

NEARFIT_QT_SUITE(ClearanceLegendTest, test::runQtTest<ClearanceLegendTest>)
#include "clearance_legend_test.moc"
