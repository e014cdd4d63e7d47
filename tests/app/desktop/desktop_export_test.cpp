#include <QClipboard>
#include <QDoubleSpinBox>
#include <QMessageBox>
#include <QStatusBar>

#include "core/import/mesh_import.h"
#include "core/report/placement_table.h"
#include "tests/app/desktop/export_driver.h"
#include "ui/model/parts_model.h"
#include "ui/widgets/error_box.h"

using namespace nearfit;
using namespace nearfit::test;

class DesktopExportTest : public QObject {
  Q_OBJECT

 private slots:
  void aMergedMeshHasThePartsWhereTheyAre();
  void onlyTheSelectedPartsAreWrittenWhenAskedFor();
  void thePlacementTableHasThePoseInHand();
  void cancellingWritesNothing();
  void whatCannotBeWrittenIsToldAndNothingIsLost();
  void thePlacementIsCopiedAsAMatrix();
  void anAssemblyKeepsThePartsApart();
  void aDotInANameIsNoSuffix();
};

void DesktopExportTest::aMergedMeshHasThePartsWhereTheyAre() {
  DesktopDriver d;
  d.addCubes();
  d.session().movePart(d.partId("moving"), {{1, 0, 0, 0}, {0, 0, 0.1}});
  for (int row = 2; row <= 4; ++row) {
    const auto file = d.folder.path() / ("all" + std::to_string(row) +
                                         (row == 2   ? ".stl"
                                          : row == 3 ? ".obj"
                                                     : ".ply"));
    QString summary;
    chooseExport(row, false, &summary);
    whenModal<QFileDialog>(
        [&](QFileDialog* dialog) { chooseFile(dialog, QString::fromStdString(file.string())); });
    pressShortcut(d, Qt::Key_E, Qt::ControlModifier);
    QTRY_COMPARE(d.window().statusBar()->currentMessage(),
                 QStringLiteral("Exported ") + QString::fromStdString(file.filename().string()));
    QVERIFY2(summary.contains(QStringLiteral("24 triangles")), qPrintable(summary));
    QVERIFY2(summary.contains(QStringLiteral("in mm")), qPrintable(summary));
    const ImportedMesh read = importMesh(file, {.metresPerUnit = 1e-3});
    QCOMPARE(read.mesh.triangles().size(), std::size_t{24});
    QVERIFY(std::abs(read.mesh.bounds().upper.z - 0.145) < 1e-8);
    QVERIFY(std::abs(read.mesh.bounds().lower.z + 0.02) < 1e-8);
  }
}

void DesktopExportTest::anAssemblyKeepsThePartsApart() {
  DesktopDriver d;
  d.addCubes();
  d.session().movePart(d.partId("moving"), {{1, 0, 0, 0}, {0, 0, 0.1}});
  const auto file = d.folder.path() / "robot.urdf";
  QString summary;
  chooseExport(9, false, &summary);
  whenModal<QFileDialog>(
      [&](QFileDialog* dialog) { chooseFile(dialog, QString::fromStdString(file.string())); });
  pressShortcut(d, Qt::Key_E, Qt::ControlModifier);
  QTRY_COMPARE(d.window().statusBar()->currentMessage(), QStringLiteral("Exported robot.urdf"));
  QVERIFY2(summary.contains(QStringLiteral("2 parts with their groups")), qPrintable(summary));
  const QString text = QString::fromStdString(readBytes(file));
  QVERIFY2(text.contains(QStringLiteral("<origin xyz=\"0 0 0.1\" rpy=\"0 0 0\"/><parent link=\"world\"/>"
                                        "<child link=\"moving\"/>")),
           qPrintable(text));
}

void DesktopExportTest::onlyTheSelectedPartsAreWrittenWhenAskedFor() {
  DesktopDriver d;
  d.addCubes();
  d.clickPart(1, ui::PartsModel::Name);
  const auto file = d.folder.path() / "moving.obj";
  chooseExport(3, true);
  whenModal<QFileDialog>(
      [&](QFileDialog* dialog) { chooseFile(dialog, QString::fromStdString(file.string())); });
  pressShortcut(d, Qt::Key_E, Qt::ControlModifier);
  QTRY_VERIFY(std::filesystem::exists(file));
  const std::string text = readBytes(file);
  QVERIFY(text.find("g moving\n") != text.npos);
  QVERIFY(text.find("g fixed\n") == text.npos);
}

void DesktopExportTest::thePlacementTableHasThePoseInHand() {
  DesktopDriver d;
  d.addCubes();
  d.startWith(ui::Hand::Manual);
  d.clickPart(1, ui::PartsModel::Name);
  d.type<QDoubleSpinBox>("positionZ", "1.5");
  QTRY_COMPARE(d.text("statusDistance"), QStringLiteral("Min distance 6.50 mm"));
  const auto file = d.folder.path() / "table.csv";
  chooseExport(1, false);
  whenModal<QFileDialog>(
      [&](QFileDialog* dialog) { chooseFile(dialog, QString::fromStdString(file.string())); });
  pressShortcut(d, Qt::Key_E, Qt::ControlModifier);
  QTRY_VERIFY(std::filesystem::exists(file));
  const QString text = QString::fromStdString(readBytes(file));
  QVERIFY2(text.contains(QStringLiteral(",1,1,0,0,0.0015,1,0,0,0,")), qPrintable(text));
}

void DesktopExportTest::cancellingWritesNothing() {
  DesktopDriver d;
  d.addCubes();
  bool wasAsked = false;
  whenModal<ui::ExportDialog>([&](ui::ExportDialog* dialog) {
    wasAsked = true;
    QTest::keyClick(dialog, Qt::Key_Escape);
  });
  pressShortcut(d, Qt::Key_E, Qt::ControlModifier);
  QVERIFY(wasAsked);
  chooseExport(2, false);
  whenModal<QFileDialog>([](QFileDialog* dialog) { dialog->reject(); });
  pressShortcut(d, Qt::Key_E, Qt::ControlModifier);
  QCOMPARE(std::distance(std::filesystem::directory_iterator(d.folder.path()), {}), std::ptrdiff_t{2});
}

void DesktopExportTest::whatCannotBeWrittenIsToldAndNothingIsLost() {
  DesktopDriver d;
  QVector<ui::Failure> failures;
  d.window().setFailureSink([&](const ui::Failure& failure) { failures << failure; });
  d.addCubes();
  std::filesystem::create_directory(d.folder.path() / "taken.obj");
  chooseExport(3, false);
  const QString file = QString::fromStdString((d.folder.path() / "missing" / "x.obj").string());
  whenModal<QFileDialog>([&](QFileDialog* dialog) {
    // The dialog itself takes no folder that is not there: it goes while the dialog is open.
    std::filesystem::create_directory(d.folder.path() / "missing");
    chooseFile(dialog, file);
    std::filesystem::remove(d.folder.path() / "missing");
  });
  pressShortcut(d, Qt::Key_E, Qt::ControlModifier);
  QTRY_COMPARE(failures.size(), 1);
  QVERIFY(failures[0].details.contains(QStringLiteral("missing/x.obj")));
}

void DesktopExportTest::thePlacementIsCopiedAsAMatrix() {
  DesktopDriver d;
  d.addCubes();
  const RigidTransform pose{glm::angleAxis(0.4, glm::normalize(glm::dvec3(1, 2, 3))), {0.01, -0.02, 0.5}};
  d.session().movePart(d.partId("fixed"), pose);
  d.clickPart(0, ui::PartsModel::Name);
  pressShortcut(d, Qt::Key_C, Qt::ControlModifier | Qt::ShiftModifier);
  const QStringList lines = QApplication::clipboard()->text().split('\n');
  QCOMPARE(lines.size(), 5);
  const QStringList second = lines[1].split(' ');
  QCOMPARE(second.size(), 4);
  QCOMPARE(second[3].toDouble(), -0.02);
  QVERIFY(std::abs(second[0].toDouble() - glm::mat4_cast(pose.rotation)[0][1]) < 1e-15);
  QCOMPARE(lines[3], QStringLiteral("0 0 0 1"));
}

void DesktopExportTest::aDotInANameIsNoSuffix() {
  DesktopDriver d;
  d.addCubes();
  const auto file = d.folder.path() / "lift.v2.nearfit";
  const QString typed = QString::fromStdString((d.folder.path() / "lift.v2").string());
  const auto saveAs = [&] {
    whenModal<QFileDialog>([typed](QFileDialog* dialog) { chooseFile(dialog, typed); });
    pressShortcut(d, Qt::Key_S, Qt::ControlModifier | Qt::ShiftModifier);
  };
  saveAs();
  QVERIFY(std::filesystem::exists(file));
  QVERIFY(!std::filesystem::exists(d.folder.path() / "lift.v2"));
  QVERIFY(d.window().windowTitle().startsWith(QStringLiteral("lift.v2.nearfit")));
  // The dialog has asked for another name than the one that stands there: so does the program.
  const std::string before = readBytes(file);
  d.session().movePart(d.partId("fixed"), {{1, 0, 0, 0}, {0, 0, -0.5}});
  for (const bool isReplaced : {false, true}) {
    whenModal<QMessageBox>(
        [isReplaced](QMessageBox* box) {
          for (QAbstractButton* button : box->buttons()) {
            const bool replaces = box->buttonRole(button) == QMessageBox::DestructiveRole;
            if (replaces == isReplaced) return QTest::mouseClick(button, Qt::LeftButton);
          }
        },
        QStringLiteral("replaceFile"));
    if (!isReplaced) {
      whenModal<QFileDialog>([typed](QFileDialog* dialog) {
        chooseFile(dialog, typed);
        // Cancelled, it is there once more.
        whenModal<QFileDialog>([](QFileDialog* again) { again->reject(); });
      });
      pressShortcut(d, Qt::Key_S, Qt::ControlModifier | Qt::ShiftModifier);
      QCOMPARE(readBytes(file), before);
    } else {
      saveAs();
      QVERIFY(readBytes(file) != before);
    }
  }
}

NEARFIT_QT_SUITE(DesktopExportTest, runDesktopTest<DesktopExportTest>)
#include "desktop_export_test.moc"
