// What the export dialog offers beside the format: the unit of the numbers in the file, and which parts.
#include <QStatusBar>
#include <sstream>

#include "core/import/mesh_import.h"
#include "tests/app/desktop/export_driver.h"
#include "ui/model/parts_model.h"
#include "ui/model/selection.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

constexpr int kObjRow = 3;

void press(QRadioButton* button) {
  QTest::mouseClick(button, Qt::LeftButton, {}, QPoint(8, button->height() / 2));
}

/// Chooses from the top, as many rows down.
void chooseRow(QComboBox* box, int row) {
  box->setFocus();
  QTest::keyClick(box, Qt::Key_Home);
  for (int i = 0; i < row; ++i)
    QTest::keyClick(box, Qt::Key_Down);
}

struct ExportDesk : DesktopDriver {
  ExportDesk() {
    addCubes();
    session().movePart(partId("moving"), {{1, 0, 0, 0}, {0.0, 0.03, 0.1}});
  }
  /// Exports into a file of that name what the dialog is made to say, and waits until it is written.
  std::filesystem::path exportTo(const char* name, std::function<void(ui::ExportDialog*)> make) {
    const auto file = folder.path() / name;
    whenModal<ui::ExportDialog>([make = std::move(make), this](ui::ExportDialog* dialog) {
      make(dialog);
      summary = dialog->findChild<QLabel*>(QStringLiteral("exportSummary"))->text();
      QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Save),
                        Qt::LeftButton);
    });
    whenModal<QFileDialog>(
        [file](QFileDialog* dialog) { chooseFile(dialog, QString::fromStdString(file.string())); });
    pressShortcut(*this, Qt::Key_E, Qt::ControlModifier);
    [&] {
      QTRY_COMPARE(window().statusBar()->currentMessage(), QStringLiteral("Exported ") + QLatin1String(name));
    }();
    return file;
  }
  QString summary;
};

/// Of the numbers that stand in a file: as if they were metres.
Aabb numbersIn(const std::filesystem::path& file) {
  return importMesh(file, {.metresPerUnit = 1.0}).mesh.bounds();
}

}  // namespace

class DesktopExportOptionsTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { QSettings().clear(); }
  void numbersAreInTheChosenUnit_data();
  void numbersAreInTheChosenUnit();
  void theUnitIsProposedTheNextTime();
  void hiddenPartsAreLeftOut();
};

void DesktopExportOptionsTest::numbersAreInTheChosenUnit_data() {
  QTest::addColumn<int>("row");
  QTest::addColumn<double>("metres");
  QTest::addColumn<QString>("sign");
  QTest::addColumn<int>("format");
  QTest::addColumn<QString>("suffix");
  const struct {
    int row;
    double metres;
    const char* sign;
  } units[] = {{0, 1e-3, "mm"}, {1, 1e-2, "cm"}, {2, 1.0, "m"}, {3, 0.0254, "in"}};
  for (const auto& unit : units) {
    for (const auto& [format, suffix] : {std::pair(2, "stl"), std::pair(3, "obj"), std::pair(4, "ply")})
      QTest::addRow("%s, %s", unit.sign, suffix)
          << unit.row << unit.metres << QString(unit.sign) << format << QString(suffix);
  }
}

void DesktopExportOptionsTest::numbersAreInTheChosenUnit() {
  QFETCH(int, row);
  QFETCH(double, metres);
  QFETCH(QString, sign);
  QFETCH(int, format);
  QFETCH(QString, suffix);
  ExportDesk d;
  const auto file = d.exportTo(qPrintable(QStringLiteral("out.") + suffix), [&](ui::ExportDialog* dialog) {
    chooseRow(dialog->findChild<QComboBox*>(QStringLiteral("exportKind")), format);
    chooseRow(dialog->findChild<QComboBox*>(QStringLiteral("exportUnit")), row);
  });
  QVERIFY2(d.summary.contains(QStringLiteral("in %1:").arg(sign)), qPrintable(d.summary));
  const Aabb numbers = numbersIn(file);
  // From the fixed cube's corner to that of the other one.
  const glm::dvec3 lower(-0.02), upper(0.02, 0.04, 0.145);
  // STL has single precision.
  const double slack = 1e-6 * 0.145 / metres;
  for (int axis = 0; axis < 3; ++axis) {
    QVERIFY2(std::abs(numbers.lower[axis] - lower[axis] / metres) < slack,
             qPrintable(QString::number(numbers.lower[axis])));
    QVERIFY2(std::abs(numbers.upper[axis] - upper[axis] / metres) < slack,
             qPrintable(QString::number(numbers.upper[axis])));
  }
}

void DesktopExportOptionsTest::theUnitIsProposedTheNextTime() {
  ExportDesk d;
  d.exportTo("first.obj", [](ui::ExportDialog* dialog) {
    chooseRow(dialog->findChild<QComboBox*>(QStringLiteral("exportKind")), kObjRow);
    chooseRow(dialog->findChild<QComboBox*>(QStringLiteral("exportUnit")), 3);
  });
  const auto second = d.exportTo("second.obj", [](ui::ExportDialog*) {});
  QVERIFY2(d.summary.contains(QStringLiteral("in in:")), qPrintable(d.summary));
  QVERIFY(std::abs(numbersIn(second).upper.z - 0.145 / 0.0254) < 1e-9);
}

void DesktopExportOptionsTest::hiddenPartsAreLeftOut() {
  ExportDesk d;
  // Both are selected, and one of them is hidden by its eye.
  d.choose("selectAll");
  const int row = d.session().scene().parts()[0]->name == "fixed" ? 0 : 1;
  const auto hide = [&] { d.clickPart(row, ui::PartsModel::Visible); };
  for (const bool isSelectedFirst : {false, true}) {
    d.window().selection().select(std::nullopt);
    hide();
    QVERIFY(!d.part("fixed").isVisible && d.part("moving").isVisible);
    d.choose("selectAll");
    const auto file =
        d.exportTo(isSelectedFirst ? "again.obj" : "visible.obj", [&](ui::ExportDialog* dialog) {
          chooseRow(dialog->findChild<QComboBox*>(QStringLiteral("exportKind")), kObjRow);
          if (isSelectedFirst) press(dialog->findChild<QRadioButton*>(QStringLiteral("exportSelected")));
          press(dialog->findChild<QRadioButton*>(QStringLiteral("exportVisible")));
        });
    QVERIFY2(d.summary.startsWith(QStringLiteral("1 part ")), qPrintable(d.summary));
    const std::string text = readBytes(file);
    QVERIFY(text.find("g moving\n") != text.npos);
    QVERIFY(text.find("g fixed\n") == text.npos);
    const ImportedMesh read = importMesh(file, {.metresPerUnit = 1e-3});
    QCOMPARE(read.mesh.triangles().size(), std::size_t{12});
    QVERIFY(std::abs(read.mesh.bounds().lower.z - 0.125) < 1e-8);
    d.window().selection().select(std::nullopt);
    hide();
    QVERIFY(d.part("fixed").isVisible);
  }
  // Shown again it is there again.
  const auto file = d.exportTo("all.obj", [](ui::ExportDialog* dialog) {
    press(dialog->findChild<QRadioButton*>(QStringLiteral("exportVisible")));
  });
  QCOMPARE(importMesh(file, {.metresPerUnit = 1e-3}).mesh.triangles().size(), std::size_t{24});
}

NEARFIT_QT_SUITE(DesktopExportOptionsTest, runDesktopTest<DesktopExportOptionsTest>)
#include "desktop_export_options_test.moc"
