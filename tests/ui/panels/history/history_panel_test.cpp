#include "ui/panels/history/history_panel.h"

#include <QtTest>

#include "tests/support/qt/qt_suite.h"
#include "ui/widgets/length_unit.h"

using namespace nearfit;

class HistoryPanelTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { ui::setShownLengthUnit(ui::LengthUnit::Millimetre); }
  void everyMoveNamesItsAmount_data();
  void everyMoveNamesItsAmount();
  void otherStepsHaveNone();
};

namespace {

constexpr double kDegreeOfStep = 0.017453292519943295;  ///< [rad]

QString textOfStep(const Session::Step& step) {
  ui::HistoryModel model;
  model.show({Session::Step{}, step}, 1);
  return model.data(model.index(1), Qt::DisplayRole).toString();
}

}  // namespace

void HistoryPanelTest::everyMoveNamesItsAmount_data() {
  QTest::addColumn<double>("shift");
  QTest::addColumn<double>("angle");
  QTest::addColumn<QString>("text");
  const auto row = [](const char* name, double shift, double degrees, const char* text) {
    QTest::newRow(name) << shift << degrees * kDegreeOfStep << QString::fromUtf8(text);
  };
  row("both", 0.1, 15.0, "Move pin, 100 mm, 15.0°");
  row("a tenth of a degree", 0.0, 0.1, "Move pin, 0.1°");
  row("a small angle", 0.0, 0.04, "Move pin, 0.040°");
  row("the last decimal of a field", 0.0, 0.001, "Move pin, 0.001°");
  row("less than that", 0.0, 0.0002, "Move pin, under 0.001°");
  row("a small shift", 2e-7, 0.0, "Move pin, 0.20 µm");
  row("less than is shown", 1e-9, 0.0, "Move pin, under 0.01 µm");
  row("a shift with an angle that rounding left", 0.002, 1e-6, "Move pin, 2.00 mm");
  row("an angle with a shift that rounding left", 1e-17, 0.0002, "Move pin, under 0.001°");
}

/// Small amounts were left out, so that the step was only "Move pin".
void HistoryPanelTest::everyMoveNamesItsAmount() {
  QFETCH(double, shift);
  QFETCH(double, angle);
  QFETCH(QString, text);
  QCOMPARE(textOfStep({"Move pin", shift, angle}), text);
}

void HistoryPanelTest::otherStepsHaveNone() {
  QCOMPARE(textOfStep({"Rename pin to bolt"}), QStringLiteral("Rename pin to bolt"));
}

NEARFIT_QT_SUITE(HistoryPanelTest, test::runQtTest<HistoryPanelTest>)
#include "history_panel_test.moc"
