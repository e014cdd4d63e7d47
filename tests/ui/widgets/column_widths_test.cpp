#include "ui/widgets/column_widths.h"

#include <QHeaderView>
#include <QScrollBar>
#include <QStandardItemModel>
#include <QTableView>
#include <QtTest>

#include "tests/support/qt/qt_suite.h"

using namespace nearfit;
using ui::ColumnWidths;

namespace {

constexpr int kName = 0, kNumber = 1, kReason = 2, kMost = 260;
const QString kHousing = QStringLiteral("Gearbox housing, lower");

/// A table of names that stretch, numbers and reasons.
struct WideTable {
  explicit WideTable(int width = 600) {
    view.setModel(&model);
    add(kHousing, QStringLiteral("1.20 mm"), {});
    new ColumnWidths(view, {{kMost, true}, {kMost, false}, {kMost, false}});
    view.resize(width, 200);
    view.show();
    (void)QTest::qWaitForWindowExposed(&view);
  }
  void add(const QString& name, const QString& number, const QString& reason) {
    model.appendRow({new QStandardItem(name), new QStandardItem(number), new QStandardItem(reason)});
  }
  /// The text as it is painted: in the cell less its margins, in which Qt leaves a pixel beside the focus frame.
  bool isWhole(int row, int column) const {
    const QString text = model.item(row, column)->text();
    const int margin = view.style()->pixelMetric(QStyle::PM_FocusFrameHMargin, nullptr, &view) + 1;
    const int width = view.columnWidth(column) - 2 * margin;
    return view.fontMetrics().elidedText(text, Qt::ElideRight, width) == text;
  }
  int total() const {
    return view.columnWidth(kName) + view.columnWidth(kNumber) + view.columnWidth(kReason);
  }

  QStandardItemModel model{0, 3};
  QTableView view;
};

}  // namespace

class ColumnWidthsTest : public QObject {
  Q_OBJECT

 private slots:
  void contentsAreShownWholeAndTheNamesTakeWhatIsLeft();
  void aLongTextIsBoundedUnlessThereIsRoom();
  void widthsStayWhenContentsGetShorter();
  void aColumnThatTheUserResizedIsLeftAlone();
  void aNarrowTableScrollsInsteadOfCuttingNames();
};

void ColumnWidthsTest::contentsAreShownWholeAndTheNamesTakeWhatIsLeft() {
  WideTable t;
  QVERIFY(t.isWhole(0, kName) && t.isWhole(0, kNumber));
  QCOMPARE(t.total(), t.view.viewport()->width());
  const int number = t.view.columnWidth(kNumber);
  t.view.resize(900, 200);
  QTRY_COMPARE(t.total(), t.view.viewport()->width());
  QCOMPARE(t.view.columnWidth(kNumber), number);
}

void ColumnWidthsTest::aLongTextIsBoundedUnlessThereIsRoom() {
  WideTable t(300);
  t.model.item(0, kReason)->setText(QStringLiteral("because ").repeated(40));
  QCOMPARE(t.view.columnWidth(kReason), kMost);
  QVERIFY(!t.isWhole(0, kReason) && t.isWhole(0, kName));
  t.view.resize(1000, 200);
  QTRY_VERIFY(t.view.columnWidth(kReason) > kMost);
}

void ColumnWidthsTest::widthsStayWhenContentsGetShorter() {
  WideTable t(300);
  t.add(QStringLiteral("x"), QStringLiteral("at most 123.45 mm"), {});
  t.model.item(1, kNumber)->setText(QStringLiteral("at most 1234.5 mm"));
  const int name = t.view.columnWidth(kName), number = t.view.columnWidth(kNumber);
  QVERIFY(t.isWhole(1, kNumber));
  t.model.item(0, kName)->setText(QStringLiteral("y"));
  t.model.item(1, kNumber)->setText(QStringLiteral("0"));
  QCOMPARE(t.view.columnWidth(kName), name);
  QCOMPARE(t.view.columnWidth(kNumber), number);
}

void ColumnWidthsTest::aColumnThatTheUserResizedIsLeftAlone() {
  WideTable t;
  t.view.horizontalHeader()->resizeSection(kName, 70);
  t.model.item(0, kName)->setText(kHousing + kHousing);
  t.view.resize(1000, 200);
  QTest::qWait(0);
  QCOMPARE(t.view.columnWidth(kName), 70);
}

void ColumnWidthsTest::aNarrowTableScrollsInsteadOfCuttingNames() {
  const WideTable t(160);
  QVERIFY(t.isWhole(0, kName));
  QVERIFY(t.view.horizontalScrollBar()->maximum() > 0);
}

NEARFIT_QT_SUITE(ColumnWidthsTest, test::runQtTest<ColumnWidthsTest>)
#include "column_widths_test.moc"
