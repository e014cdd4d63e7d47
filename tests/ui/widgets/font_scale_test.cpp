#include "ui/widgets/font_scale.h"

#include <QLabel>
#include <QtTest>
#include <cstdlib>

#include "tests/support/qt/qt_suite.h"

using namespace nearfit;

class FontScaleTest : public QObject {
  Q_OBJECT

 private slots:
  void sizesGrowWithTheLettersAndNeverShrink();
};

void FontScaleTest::sizesGrowWithTheLettersAndNeverShrink() {
  QLabel label;
  QFont font = label.font();
  font.setPixelSize(4);
  label.setFont(font);
  QCOMPARE(ui::forFont(label, 100), 100);
  font.setPixelSize(40);
  label.setFont(font);
  const int height = label.fontMetrics().height();
  QVERIFY(height > 17);
  QCOMPARE(ui::forFont(label, 17), height);
  QVERIFY(std::abs(ui::forFont(label, 340) - 20 * height) <= 1);
}

NEARFIT_QT_SUITE(FontScaleTest, test::runQtTest<FontScaleTest>)
#include "font_scale_test.moc"
