#pragma once

#include <QAbstractItemView>
#include <QComboBox>
#include <QtTest>
#include <array>
#include <string>

#include "app/desktop/device_source.h"
#include "tests/app/desktop/desktop_driver.h"
#include "tests/makers/maker_bench.h"
#include "tests/support/places.h"
#include "tests/support/scoped_variable.h"

namespace nearfit::test {

/// Nobody listens there.
inline constexpr const char* kNoHaply = "1";

/// The window with the plug-ins that the build puts beside the programs, and a service of Haply's at that port.
struct DriversFixture {
  explicit DriversFixture(const std::string& haplyPort = kNoHaply) : haply("NEARFIT_HAPLY_PORT", haplyPort) {}

  ScopedVariable plugins{"NEARFIT_PLUGINS", test::builtPath("plugins")};
  ScopedVariable haply;
  DesktopDriver d{desktop::makeDeviceSource()};

  QComboBox* box() { return d.widget<QComboBox>("hand"); }
  bool isEnabled(int row) { return (box()->model()->index(row, 0).flags() & Qt::ItemIsEnabled) != 0; }
};

/// How a maker's device is listed where its driver is there.
struct DriverRow {
  const char *maker, *device;
};
inline constexpr std::array kDriverRows = {DriverRow{"OpenHaptics", "Touch or PHANTOM, Default Device"},
                                           DriverRow{"Force Dimension", "Force Dimension device 1"},
                                           DriverRow{"Haply", "Haply Inverse3 with VerseGrip"}};

/// Opens the list of hands and checks its rows: for each maker its device, or a grey line if its driver is missing.
/// @param missing  Makers whose drivers are.
/// @param picture  Name of the pictures of the open list.
inline void checkOpenList(DriversFixture& f, const QStringList& missing, const QString& picture) {
  const auto textOf = [&](const DriverRow& row, bool isMissing) {
    return isMissing ? QString::fromLatin1(row.maker) + QStringLiteral(": driver not installed")
                     : QString::fromLatin1(row.device);
  };
  const auto isMissing = [&](const DriverRow& row) {
    return missing.contains(QString::fromLatin1(row.maker));
  };
  for (const DriverRow& row : kDriverRows) {
    QTRY_VERIFY2(f.box()->findText(textOf(row, isMissing(row))) >= 0, row.maker);
    QVERIFY2(f.box()->findText(textOf(row, !isMissing(row))) < 0, row.maker);
  }
  f.box()->showPopup();
  QAbstractItemView* view = f.box()->view();
  QTRY_VERIFY(view->isVisible());
  for (const DriverRow& row : kDriverRows) {
    const int at = f.box()->findText(textOf(row, isMissing(row)));
    QVERIFY2(at >= 0, row.maker);
    const QModelIndex index = view->model()->index(at, 0);
    QVERIFY2(!view->visualRect(index).isEmpty(), row.maker);
    // Icon and margins: a list of less cut names short in the pictures.
    constexpr int kBesideName = 55;
    const int name = view->fontMetrics().horizontalAdvance(index.data().toString());
    QVERIFY2(view->viewport()->width() >= name + kBesideName, "its name is cut");
    QCOMPARE(f.isEnabled(at), !isMissing(row));
  }
  keepPictures(*view->window(), picture);
  f.box()->hidePopup();
}

}  // namespace nearfit::test
