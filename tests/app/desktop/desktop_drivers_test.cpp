// Devices behind makers' drivers: which of them are missing, and what devices with fewer motors than axes do not show.
#include <QComboBox>
#include <QtTest>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include <dlfcn.h>

#include "app/desktop/device_source.h"
#include "app/desktop/servo_report.h"
#include "tests/app/desktop/desktop_driver.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

using namespace nearfit;
using namespace nearfit::test;

class DesktopDriversTest : public QObject {
  Q_OBJECT

 private slots:
  void eachMissingDriverIsAGreyEntryThatSaysWhatToInstall();
  void devicesOfDriversThatAreThereCanBeChosen();
  void aTouchSaysThatTorqueIsNotFelt();
  void anOmega3SaysThatItSensesNoTurning();
  void whatPushesAlongAllOrDoesNotPushSaysNothing();
  void aDeviceThatIsStoppedSaysOnlyWhy();

 private:
  static DeviceInfo infoOf(int sensed, int pushed) {
    DeviceInfo info;
    info.sensedAxes = sensed;
    info.forceAxes = pushed;
    return info;
  }
};

namespace {

/// The plug-ins that the build puts beside the programs, and no service of Haply's.
struct DriversFixture {
  ScopedVariable plugins{"NEARFIT_PLUGINS", NEARFIT_PLUGIN_FOLDER};
  ScopedVariable haply{"NEARFIT_HAPLY_PORT", "1"};
  DesktopDriver d{desktop::makeDeviceSource()};

  QComboBox* box() { return d.widget<QComboBox>("hand"); }
  bool isEnabled(int row) { return (box()->model()->index(row, 0).flags() & Qt::ItemIsEnabled) != 0; }
};

}  // namespace

void DesktopDriversTest::eachMissingDriverIsAGreyEntryThatSaysWhatToInstall() {
  DriversFixture f;
  for (const auto& [maker, remedy] :
       {std::pair{"OpenHaptics", "Touch_Setup"}, std::pair{"Force Dimension", "SDK"},
        std::pair{"Haply", "haply-inverse-service"}}) {
    const QString name = QString::fromLatin1(maker) + QStringLiteral(": driver not installed");
    QTRY_VERIFY2(f.box()->findText(name) >= 0, maker);
    const int row = f.box()->findText(name);
    QVERIFY(!f.isEnabled(row));
    QVERIFY(f.box()->itemData(row, Qt::ToolTipRole).toString().contains(QLatin1String(remedy)));
  }
  keepPictures(f.d.window(), QStringLiteral("drivers-missing"));
}

void DesktopDriversTest::devicesOfDriversThatAreThereCanBeChosen() {
  // The loader knows what stands in for the makers' libraries by their names from here on.
  for (const char* library : {"/libHD.so", "/libdrd.so"})
    QVERIFY2(::dlopen((std::string(NEARFIT_STANDIN_FOLDER) + library).c_str(), RTLD_NOW) != nullptr, library);
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "config");
  std::ofstream(folder.path() / "config" / "Default Device.config") << "[DEVICE]\n";
  const ScopedVariable setup("GTDD_HOME", folder.path().string());
  DriversFixture f;
  for (const char* name : {"Touch or PHANTOM, Default Device", "Force Dimension device 1"}) {
    QTRY_VERIFY2(f.box()->findText(QLatin1String(name)) >= 0, name);
    QVERIFY2(f.isEnabled(f.box()->findText(QLatin1String(name))), name);
  }
  QVERIFY(f.box()->findText(QStringLiteral("OpenHaptics: driver not installed")) < 0);
  keepPictures(f.d.window(), QStringLiteral("drivers-present"));
}

void DesktopDriversTest::aTouchSaysThatTorqueIsNotFelt() {
  for (const DeviceState state : {DeviceState::Ready, DeviceState::Armed})
    QVERIFY(desktop::missingAxesText(state, infoOf(6, 3)).contains(QStringLiteral("no motors for torque")));
}

void DesktopDriversTest::anOmega3SaysThatItSensesNoTurning() {
  QVERIFY(desktop::missingAxesText(DeviceState::Armed, infoOf(3, 3))
              .contains(QStringLiteral("senses no turning")));
}

void DesktopDriversTest::whatPushesAlongAllOrDoesNotPushSaysNothing() {
  QCOMPARE(desktop::missingAxesText(DeviceState::Armed, infoOf(6, 6)), QString());
  QCOMPARE(desktop::missingAxesText(DeviceState::Armed, infoOf(6, 0)), QString());
}

void DesktopDriversTest::aDeviceThatIsStoppedSaysOnlyWhy() {
  for (const DeviceState state : {DeviceState::Fault, DeviceState::Lost, DeviceState::Uncalibrated})
    QCOMPARE(desktop::missingAxesText(state, infoOf(6, 3)), QString());
}

NEARFIT_QT_SUITE(DesktopDriversTest, runDesktopTest<DesktopDriversTest>)

#include "desktop_drivers_test.moc"
