#include "ui/widgets/window_style.h"

#include <QApplication>
#include <QCheckBox>
#include <QIcon>
#include <QImage>
#include <QPainter>
#include <QRadioButton>
#include <QSettings>
#include <QTemporaryDir>
#include <QToolTip>
#include <QtTest>
#include <algorithm>
#include <cstdlib>

#include "tests/support/qt/contrast.h"
#include "tests/support/qt/qt_suite.h"
#include "ui/widgets/theme.h"

using namespace nearfit;
using test::contrast;

namespace {

/// Contrast of the pixel that stands out most from a ground.
double bestContrast(const QImage& picture, const QColor& ground) {
  double best = 1.0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x)
      best = std::max(best, contrast(picture.pixelColor(x, y), ground));
  }
  return best;
}

/// The tooltip that is shown; null if there is none.
QWidget* shownTooltip() {
  for (QWidget* widget : QApplication::topLevelWidgets()) {
    if (widget->inherits("QTipLabel") && widget->isVisible()) return widget;
  }
  return nullptr;
}

QImage iconDrawn(const QIcon& icon, QIcon::Mode mode, const QColor& ground) {
  QImage image(24, 24, QImage::Format_RGB32);
  image.fill(ground);
  QPainter painter(&image);
  icon.paint(&painter, image.rect(), Qt::AlignCenter, mode);
  return image;
}

}  // namespace

class WindowStyleTest : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase();
  void boxesToTickStandOutInBothThemes_data();
  void boxesToTickStandOutInBothThemes();
  void tooltipsAreReadableInBothThemes_data();
  void tooltipsAreReadableInBothThemes();
  void textOfThePastAndOfJointsIsReadable();
  void outlinesStandOutFromTheViewInBothThemes_data();
  void outlinesStandOutFromTheViewInBothThemes();
  void disabledIconsAreFaintInBothThemes_data();
  void disabledIconsAreFaintInBothThemes();

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

void WindowStyleTest::tooltipsAreReadableInBothThemes_data() {
  boxesToTickStandOutInBothThemes_data();
}

// White on dark was translated as if it were the ground of a light window: #1a1f24 on #39434d.
void WindowStyleTest::tooltipsAreReadableInBothThemes() {
  QFETCH(int, scheme);
  ui::setColourScheme(static_cast<ui::ColourScheme>(scheme));
  QToolTip::showText(QPoint(40, 40), QStringLiteral("Stop the servo"));
  QTRY_VERIFY(shownTooltip() != nullptr);
  QWidget* tip = shownTooltip();
  const QImage picture = tip->grab().toImage();
  const double best = bestContrast(picture, picture.pixelColor(2, picture.height() / 2));
  QVERIFY2(best >= 4.5, qPrintable(QString::number(best)));
  QToolTip::hideText();
}

void WindowStyleTest::textOfThePastAndOfJointsIsReadable() {
  ui::setColourScheme(ui::ColourScheme::Light);
  QVERIFY(contrast(ui::themed(ui::colours::kJointText), QColor(0xe4, 0xe9, 0xee)) >= 4.5);
  ui::setColourScheme(ui::ColourScheme::Dark);
  const QPalette palette = QApplication::palette();
  QVERIFY(contrast(palette.color(QPalette::Disabled, QPalette::WindowText),
                   palette.color(QPalette::Window)) >= 4.5);
  QVERIFY(contrast(ui::themed(ui::colours::kJointText), palette.color(QPalette::Window)) >= 4.5);
  ui::setColourScheme(ui::ColourScheme::Light);
}

void WindowStyleTest::outlinesStandOutFromTheViewInBothThemes_data() {
  boxesToTickStandOutInBothThemes_data();
}

// In the dark theme they were #1a222b, half transparent, before #454f5c.
void WindowStyleTest::outlinesStandOutFromTheViewInBothThemes() {
  QFETCH(int, scheme);
  ui::setColourScheme(static_cast<ui::ColourScheme>(scheme));
  const ui::ViewGround ground = ui::viewGround();
  for (const QColor& light :
       {ui::colours::kOutline, ui::colours::kAccent, ui::colours::kMoving, ui::colours::kOverlap}) {
    const QColor shown = ui::outlineColour(light);
    for (const QColor& behind : {ground.lower, ground.upper}) {
      const double found = contrast(shown, behind);
      QVERIFY2(found >= 3.0,
               qPrintable(QStringLiteral("%1 before %2: %3").arg(shown.name(), behind.name()).arg(found)));
    }
  }
}

void WindowStyleTest::disabledIconsAreFaintInBothThemes_data() {
  boxesToTickStandOutInBothThemes_data();
}

void WindowStyleTest::disabledIconsAreFaintInBothThemes() {
  QFETCH(int, scheme);
  ui::setColourScheme(static_cast<ui::ColourScheme>(scheme));
  const QColor ground = QApplication::palette().color(QPalette::Window);
  for (const char* name : {"hand", "stop", "start"}) {
    const QIcon icon = ui::icon(QLatin1String(name));
    const double usable = bestContrast(iconDrawn(icon, QIcon::Normal, ground), ground) - 1.0;
    const double disabled = bestContrast(iconDrawn(icon, QIcon::Disabled, ground), ground) - 1.0;
    QVERIFY2(disabled > 0.1, name);
    QVERIFY2(disabled < 0.5 * usable,
             qPrintable(QStringLiteral("%1: %2 of %3").arg(QLatin1String(name)).arg(disabled).arg(usable)));
  }
}

NEARFIT_QT_SUITE(WindowStyleTest, test::runQtTest<WindowStyleTest>)
#include "window_style_test.moc"
