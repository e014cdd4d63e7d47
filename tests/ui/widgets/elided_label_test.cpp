#include "ui/widgets/elided_label.h"

#include <QtTest>

#include "tests/support/qt/qt_suite.h"

using namespace nearfit;

class ElidedLabelTest : public QObject {
  Q_OBJECT

 private slots:
  void itsStartStaysWholeWhereThereIsRoom();
};

void ElidedLabelTest::itsStartStaysWholeWhereThereIsRoom() {
  const QString start = QStringLiteral("Kept in plane of ");
  const QString text = start + QStringLiteral("factory_round_hole_16mm_loose");
  ui::ElidedLabel label;
  label.setText(text);
  label.setWholeStart(start.size());
  const QFontMetrics letters = label.fontMetrics();
  label.resize(letters.horizontalAdvance(text) + 20, 20);
  QCOMPARE(label.shownText(), text);
  label.resize(letters.horizontalAdvance(start + QStringLiteral("factory_16mm")), 20);
  QVERIFY2(label.shownText().startsWith(start + QStringLiteral("f")), qPrintable(label.shownText()));
  QVERIFY(label.shownText().contains(QChar(0x2026)) && label.shownText().endsWith(QStringLiteral("e")));
  QVERIFY(letters.horizontalAdvance(label.shownText()) <= label.width());
  // With too little room, the whole is elided.
  label.resize(letters.horizontalAdvance(start), 20);
  QVERIFY(!label.shownText().startsWith(start));
  QVERIFY(label.shownText().endsWith(QStringLiteral("e")));
}

NEARFIT_QT_SUITE(ElidedLabelTest, test::runQtTest<ElidedLabelTest>)
#include "elided_label_test.moc"
