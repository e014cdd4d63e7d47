#include <QMessageBox>
#include <QSpinBox>
#include <QStatusBar>

#include "tests/app/desktop/desktop_driver.h"
#include "tests/support/html_document.h"
#include "ui/files/export/report_dialog.h"
#include "ui/widgets/error_box.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/preferences.h"

using namespace nearfit;
using namespace nearfit::test;

class DesktopReportTest : public QObject {
  Q_OBJECT

 private slots:
  void aReportHasTheVerdictAndTheHashOfTheSavedScene();
  void theThresholdIsTheOneThatIsTyped();
  void theThresholdOfTheSceneCheckIsOffered();
  void asManyFindingsHavePicturesAsAreTyped();
  void theSceneIsReportedAsItIsAndNotAsItWasSaved();
  void aCertificateThatCannotBeReadIsToldAndNothingIsWritten();
  void cancellingWritesNothing();
  void aReportIsWrittenWhileAPartIsFelt();
};

namespace {

/// Answers the dialog of reports; typed texts that are null leave a field as it is.
void answerReport(const char* threshold, const QString& certificate = {}) {
  whenModal<ui::ReportDialog>([=](ui::ReportDialog* dialog) {
    if (threshold != nullptr) {
      auto* field = dialog->findChild<ui::NumberField*>(QStringLiteral("reportThreshold"));
      field->setFocus();
      field->selectAll();
      QTest::keyClicks(field, QLatin1String(threshold));
    }
    if (!certificate.isEmpty())
      QTest::keyClicks(dialog->findChild<QLineEdit*>(QStringLiteral("reportCertificate")), certificate);
    QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Save), Qt::LeftButton);
  });
}

void answerFile(const std::filesystem::path& file) {
  whenModal<QFileDialog>(
      [name = QString::fromStdString(file.string())](QFileDialog* dialog) { chooseFile(dialog, name); });
}

QString textOf(const std::filesystem::path& report, const char* section) {
  return QString::fromStdString(elementWithId(htmlDocument(readBytes(report)), section).text);
}

}  // namespace

void DesktopReportTest::aReportHasTheVerdictAndTheHashOfTheSavedScene() {
  DesktopDriver d;
  d.addCubes();
  d.session().save(d.folder.path() / "cubes.nearfit");
  const auto report = d.folder.path() / "cubes.html";
  answerReport("10 mm");
  answerFile(report);
  d.choose("report");
  QTRY_VERIFY2(d.window().statusBar()->currentMessage().startsWith(QStringLiteral("Wrote cubes.html. Fits")),
               qPrintable(d.window().statusBar()->currentMessage()));
  const HtmlElement page = htmlDocument(readBytes(report));
  QCOMPARE(QString::fromStdString(elementsOf(page, "h1").front().text), QStringLiteral("Fit report: cubes"));
  QVERIFY(
      textOf(report, "summary").contains(QStringLiteral("nearest are \"fixed\" and \"moving\", 5 mm apart")));
  QVERIFY(!textOf(report, "inputs").contains(QStringLiteral("not as saved")));
  QVERIFY(textOf(report, "inputs").contains(QStringLiteral("cubes.nearfit")));
}

void DesktopReportTest::theThresholdIsTheOneThatIsTyped() {
  DesktopDriver d;
  d.addCubes();
  const auto report = d.folder.path() / "cubes.html";
  answerReport("4 mm");
  answerFile(report);
  d.choose("report");
  QTRY_VERIFY(std::filesystem::exists(report));
  QVERIFY(textOf(report, "summary").contains(QStringLiteral("all are farther apart than 4 mm")));
  QVERIFY(textOf(report, "inputs").contains(QStringLiteral("was not saved")));
}

void DesktopReportTest::asManyFindingsHavePicturesAsAreTyped() {
  DesktopDriver d;
  d.addCubes();
  const PartId third = d.session().duplicatePart(d.partId("moving"));
  d.session().movePart(third, {{1, 0, 0, 0}, {0, 0, 0.025}});
  const auto pictured = [&](const QString& typed) {
    const auto report = d.folder.path() / ("cubes" + typed.toStdString() + ".html");
    d.window().statusBar()->clearMessage();
    whenModal<ui::ReportDialog>([typed](ui::ReportDialog* dialog) {
      auto* field = dialog->findChild<QSpinBox*>(QStringLiteral("reportPictures"));
      QCOMPARE(field->value(), 30);
      field->setFocus();
      field->selectAll();
      QTest::keyClicks(field, typed);
      dialog->findChild<ui::NumberField*>(QStringLiteral("reportThreshold"))->showQuantity(0.01);
      QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Save),
                        Qt::LeftButton);
    });
    answerFile(report);
    d.choose("report");
    [&] { QTRY_VERIFY(d.window().statusBar()->currentMessage().startsWith(QStringLiteral("Wrote"))); }();
    return elementsOf(elementWithId(htmlDocument(readBytes(report)), "findings"), "h3").size();
  };
  QCOMPARE(pictured(QStringLiteral("1")), std::size_t{1});
  QCOMPARE(pictured(QStringLiteral("0")), std::size_t{2});
}

/// That of the springs was, ten times as much.
void DesktopReportTest::theThresholdOfTheSceneCheckIsOffered() {
  DesktopDriver d;
  d.addCubes();
  double offered = -1.0;
  const auto ask = [&] {
    whenModal<ui::ReportDialog>([&offered](ui::ReportDialog* dialog) {
      offered = dialog->threshold();
      dialog->reject();
    });
    d.choose("report");
  };
  ask();
  QCOMPARE(offered, 0.001);
  d.choose("checkScene");
  QTRY_VERIFY(d.widget<QDoubleSpinBox>("sceneCheckThreshold")->isVisible());
  d.type<QDoubleSpinBox>("sceneCheckThreshold", "2.5 mm");
  ask();
  ui::Preferences::setCheckThreshold(0.001);
  QCOMPARE(offered, 0.0025);
}

void DesktopReportTest::theSceneIsReportedAsItIsAndNotAsItWasSaved() {
  DesktopDriver d;
  d.addCubes();
  d.session().save(d.folder.path() / "cubes.nearfit");
  d.session().movePart(d.partId("moving"), {{1, 0, 0, 0}, {0, 0, -0.01}});
  const auto report = d.folder.path() / "cubes.html";
  answerReport(nullptr);
  answerFile(report);
  d.choose("report");
  QTRY_VERIFY2(
      d.window().statusBar()->currentMessage().startsWith(QStringLiteral("Wrote cubes.html. Does not fit")),
      qPrintable(d.window().statusBar()->currentMessage()));
  QVERIFY(textOf(report, "pairs").contains(QStringLiteral("clash")));
  QVERIFY(textOf(report, "inputs").contains(QStringLiteral("not as saved")));
}

void DesktopReportTest::aCertificateThatCannotBeReadIsToldAndNothingIsWritten() {
  DesktopDriver d;
  d.addCubes();
  QStringList told;
  d.window().setFailureSink(
      [&told](const ui::Failure& failure) { told << failure.summary << failure.details; });
  const auto report = d.folder.path() / "cubes.html";
  answerReport(nullptr, QString::fromStdString((d.folder.path() / "none.nfcert").string()));
  answerFile(report);
  d.choose("report");
  QTRY_COMPARE(told.size(), 2);
  QCOMPARE(told[0], QStringLiteral("No report was written."));
  QVERIFY2(told[1].contains(QStringLiteral("none.nfcert")), qPrintable(told[1]));
  QVERIFY(!std::filesystem::exists(report));
}

void DesktopReportTest::cancellingWritesNothing() {
  DesktopDriver d;
  QVERIFY(!d.action("report")->isEnabled());
  d.addCubes();
  QVERIFY(d.action("report")->isEnabled());
  whenModal<ui::ReportDialog>([](ui::ReportDialog* dialog) {
    keepPictures(*dialog, QStringLiteral("report-dialog"));
    QTest::keyClick(dialog, Qt::Key_Escape);
  });
  d.choose("report");
  QVERIFY(QApplication::activeModalWidget() == nullptr);
  answerReport(nullptr);
  whenModal<QFileDialog>([](QFileDialog* dialog) { dialog->reject(); });
  d.choose("report");
  QVERIFY(QApplication::activeModalWidget() == nullptr);
  QVERIFY(!std::filesystem::exists(d.folder.path() / "report.html"));
}

void DesktopReportTest::aReportIsWrittenWhileAPartIsFelt() {
  DesktopDriver d;
  d.addCubes();
  d.startWith(ui::Hand::Manual);
  const auto report = d.folder.path() / "cubes.html";
  answerReport("10 mm");
  answerFile(report);
  d.choose("report");
  QTRY_VERIFY2(d.window().statusBar()->currentMessage().startsWith(QStringLiteral("Wrote cubes.html. Fits")),
               qPrintable(d.window().statusBar()->currentMessage()));
  QVERIFY(
      textOf(report, "summary").contains(QStringLiteral("nearest are \"fixed\" and \"moving\", 5 mm apart")));
  QVERIFY2(d.application.servo().isRunning(), "it goes on");
  const std::uint64_t ticks = d.application.servo().statistics().ticks;
  QTRY_VERIFY(d.application.servo().statistics().ticks > ticks);
}

NEARFIT_QT_SUITE(DesktopReportTest, runDesktopTest<DesktopReportTest>)
#include "desktop_report_test.moc"
