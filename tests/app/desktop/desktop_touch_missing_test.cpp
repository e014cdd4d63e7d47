// A Touch's driver is missing while those of others are there. A program of its own: once a driver is loaded it stays.
#include <QtTest>

#include "tests/app/desktop/drivers_fixture.h"

using namespace nearfit;
using namespace nearfit::test;

class DesktopTouchMissingTest : public QObject {
  Q_OBJECT

 private slots:
  void isListedInGreyBesideDevicesOfOthers();
};

void DesktopTouchMissingTest::isListedInGreyBesideDevicesOfOthers() {
  const MakerBench omega(kMakerModels[3]);
  MakerBench haply(kMakerModels[6]);
  DriversFixture f(std::to_string(haply.service().port()));
  checkOpenList(f, {QStringLiteral("OpenHaptics")}, QStringLiteral("drivers-without-openhaptics"));
}

NEARFIT_QT_SUITE(DesktopTouchMissingTest, runDesktopTest<DesktopTouchMissingTest>)

#include "desktop_touch_missing_test.moc"
