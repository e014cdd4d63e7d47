#include "ui/widgets/window_style.h"

#include <QApplication>
#include <QCheckBox>
#include <QImage>
#include <QRadioButton>
#include <QSettings>
#include <QTemporaryDir>
#include <QtTest>
#include <algorithm>
#include <cstdlib>

#include "tests/support/qt/qt_suite.h"
#include "ui/widgets/theme.h"

using namespace nearfit;

class WindowStyleTest : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase();
  void boxesToTickStandOutInBothThemes_data();
  void boxesToTickStandOutInBothThemes();

 private:
  QTemporaryDir settings_;
};

void WindowStyleTest::initTestCase() {
  QVERIFY(settings_.isValid());
  QSettings::setDefaultFormat(QSettings::IniFormat);
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, settings_.path());
  ui::applyTheme(*qApp);
}

void WindowStyleTest::boxesToTickStandOutInBothThemes_data() {
  QTest::addColumn<int>("scheme");
  QTest::newRow("light") << static_cast<int>(ui::ColourScheme::Light);
  QTest::newRow("dark") << static_cast<int>(ui::ColourScheme::Dark);
}

// In the dark theme their frames were a little darker than what lay around them.
void WindowStyleTest::boxesToTickStandOutInBothThemes() {
  QFETCH(int, scheme);
  ui::setColourScheme(static_cast<ui::ColourScheme>(scheme));
  QCheckBox box;
  QRadioButton circle;
  for (QAbstractButton* button :
       {static_cast<QAbstractButton*>(&box), static_cast<QAbstractButton*>(&circle)}) {
    button->resize(button->sizeHint());
    const QImage picture = button->grab().toImage();
    const int around = qGray(picture.pixel(picture.width() - 1, picture.height() - 1));
    int most = 0;
    for (int x = 0; x < picture.width(); ++x)
      most = std::max(most, std::abs(qGray(picture.pixel(x, picture.height() / 2)) - around));
    QVERIFY2(most >= 45, qPrintable(QStringLiteral("%1 of 255").arg(most)));
  }
}

NEARFIT_QT_SUITE(WindowStyleTest, test::runQtTest<WindowStyleTest>)
#include "window_style_test.moc"
