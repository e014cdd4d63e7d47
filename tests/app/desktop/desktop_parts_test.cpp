#include <QComboBox>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>

#include "tests/app/desktop/desktop_driver.h"
#include "ui/model/parts_model.h"

using namespace nearfit;
using namespace nearfit::test;

class DesktopPartsTest : public QObject {
  Q_OBJECT

 private slots:
  void addsAPartThroughTheDialogsInTheUnitChosen();
  void cancellingTheUnitAddsNothing();
  void manyFilesAreOneStepOfUndo();
  void refusedFileIsNamedAndNothingIsLost();
  void iconsOfTheListSwitchHandVisibilityAndLock();
  void renamesInPlace();
  void movesByNumbersAndTakesItBackByKeys();
  void movesByUnitsAndArithmeticInTheChosenUnit();
  void typedAnglesTurnAboutThePivot();
  void commandKeysWorkInANumberField();
  void numbersLeftAloneStayExact();
  void densityMakesTheMass();
  void deletesAndDuplicatesTheSelectedPart();
  void clickInTheViewSelectsThePart();
  void arrowKeysMoveTheSelectedPart();
  void idleViewDrawsNothing();
};

void DesktopPartsTest::addsAPartThroughTheDialogsInTheUnitChosen() {
  DesktopDriver d;
  whenModal<QFileDialog>([&](QFileDialog* dialog) {
    whenModal<QDialog>(
        [](QDialog* question) {
          QVERIFY(question->findChild<QRadioButton*>(QStringLiteral("unit-mm"))->isChecked());
          answerUnit(question, "cm");
        },
        QStringLiteral("unitDialog"));
    chooseFile(dialog, d.fixedFile);
  });
  pressShortcut(d, Qt::Key_I, Qt::ControlModifier);
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{1});
  const Part& part = d.part("fixed");
  // 40 units of a centimetre.
  QVERIFY(std::abs(part.geometry->mesh.bounds().upper.x - 0.2) < 1e-12);
  QCOMPARE(d.partsView()->model()->rowCount(), 1);
  QVERIFY(d.window().isWindowModified());
}

void DesktopPartsTest::cancellingTheUnitAddsNothing() {
  DesktopDriver d;
  whenModal<QFileDialog>([&](QFileDialog* dialog) {
    whenModal<QDialog>(
        [](QDialog* question) {
          // Another run chose centimetres; by its size it is in millimetres.
          QVERIFY(question->findChild<QRadioButton*>(QStringLiteral("unit-mm"))->isChecked());
          QTest::keyClick(question, Qt::Key_Escape);
        },
        QStringLiteral("unitDialog"));
    chooseFile(dialog, d.fixedFile);
  });
  d.choose("addParts");
  QTest::qWait(100);
  QVERIFY(!d.window().document().isBusy());
  QVERIFY(d.session().scene().parts().empty());
}

void DesktopPartsTest::manyFilesAreOneStepOfUndo() {
  DesktopDriver d;
  d.add({d.fixedFile, d.movingFile, d.fixedFile});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{3});
  QVERIFY(d.action("undo")->text().contains(QStringLiteral("Add 3 parts")));
  pressShortcut(d, Qt::Key_Z, Qt::ControlModifier);
  QVERIFY(d.session().scene().parts().empty());
  QVERIFY(!d.action("undo")->isEnabled());
  pressShortcut(d, Qt::Key_Y, Qt::ControlModifier);
  QCOMPARE(d.session().scene().parts().size(), std::size_t{3});
}

void DesktopPartsTest::refusedFileIsNamedAndNothingIsLost() {
  DesktopDriver d;
  const auto broken = d.folder.write("broken.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  d.add({d.fixedFile, QString::fromStdString(broken.string())});
  QTRY_VERIFY(d.widget<QDialog>("errorBox") != nullptr);
  QVERIFY(d.text("errorDetails").contains(QStringLiteral("broken.off")));
  QTest::keyClick(d.widget<QDialog>("errorBox"), Qt::Key_Return);
  QTRY_VERIFY(d.widget<QDialog>("errorBox") == nullptr);
  QCOMPARE(d.session().scene().parts().size(), std::size_t{1});
  QVERIFY(d.session().scene().findByName("fixed") != nullptr);
}

void DesktopPartsTest::iconsOfTheListSwitchHandVisibilityAndLock() {
  DesktopDriver d;
  d.addCubes();
  d.clickPart(0, ui::PartsModel::Moving);
  QCOMPARE(d.session().scene().movingPart(), std::optional(d.partId("fixed")));
  d.clickPart(0, ui::PartsModel::Moving);
  QVERIFY(!d.session().scene().movingPart());
  d.clickPart(1, ui::PartsModel::Visible);
  QVERIFY(!d.part("moving").isVisible);
  d.clickPart(1, ui::PartsModel::Locked);
  QVERIFY(d.part("moving").isLocked);
  QVERIFY(!d.action("remove")->isEnabled());
  d.clickPart(1, ui::PartsModel::Locked);
  QVERIFY(!d.part("moving").isLocked);
}

void DesktopPartsTest::renamesInPlace() {
  DesktopDriver d;
  d.addCubes();
  d.clickPart(1, ui::PartsModel::Name);
  d.choose("rename");
  auto* editor = d.partsView()->findChild<QLineEdit*>();
  QVERIFY(editor != nullptr);
  editor->selectAll();
  QTest::keyClicks(editor, QStringLiteral("peg"));
  QTest::keyClick(editor, Qt::Key_Return);
  QTRY_VERIFY(d.session().scene().findByName("peg") != nullptr);
}

void DesktopPartsTest::movesByNumbersAndTakesItBackByKeys() {
  DesktopDriver d;
  d.addCubes();
  d.clickPart(0, ui::PartsModel::Name);
  d.type<QDoubleSpinBox>("positionX", "12.5");
  QVERIFY(std::abs(d.part("fixed").worldFromPart.translation.x - 0.0125) < 1e-15);
  d.type<QDoubleSpinBox>("rotationZ", "90");
  const glm::dvec3 turned = d.part("fixed").worldFromPart.applyToVector({1, 0, 0});
  QVERIFY(glm::distance(turned, glm::dvec3(0, 1, 0)) < 1e-12);
  QVERIFY(d.action("undo")->text().contains(QStringLiteral("Move fixed")));
  // The number field still has the focus: the keys reach the scene all the same.
  QTest::keyClick(d.widget<QDoubleSpinBox>("rotationZ"), Qt::Key_Z, Qt::ControlModifier);
  QCOMPARE(d.part("fixed").worldFromPart.rotation.z, 0.0);
  pressShortcut(d, Qt::Key_Z, Qt::ControlModifier);
  QCOMPARE(d.part("fixed").worldFromPart.translation.x, 0.0);
  QCOMPARE(d.widget<QDoubleSpinBox>("positionX")->value(), 0.0);
  pressShortcut(d, Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
  QVERIFY(std::abs(d.widget<QDoubleSpinBox>("positionX")->value() - 12.5) < 1e-9);
}

void DesktopPartsTest::movesByUnitsAndArithmeticInTheChosenUnit() {
  DesktopDriver d;
  d.addCubes();
  d.clickPart(0, ui::PartsModel::Name);
  const auto at = [&] { return d.part("fixed").worldFromPart.translation; };
  d.type<QDoubleSpinBox>("positionX", "1/4 in");
  QVERIFY(std::abs(at().x - 0.00635) < 1e-15);
  d.type<QDoubleSpinBox>("positionX", "+= 2*(3 mm + 0,5 cm)");
  QVERIFY(std::abs(at().x - 0.02235) < 1e-15);
  d.type<QDoubleSpinBox>("rotationZ", "pi/2 rad");
  QVERIFY(glm::distance(d.part("fixed").worldFromPart.applyToVector({1, 0, 0}), glm::dvec3(0, 1, 0)) < 1e-12);
  // A mistake moves nothing and stays until it is mended; choosing another part takes it back.
  d.type<QDoubleSpinBox>("positionY", "3 mm * 2 mm");
  QCOMPARE(at().y, 0.0);
  QCOMPARE(d.widget<QDoubleSpinBox>("positionY")->text(), QStringLiteral("3 mm * 2 mm"));
  d.clickPart(1, ui::PartsModel::Name);
  QCOMPARE(d.widget<QDoubleSpinBox>("positionY")->text(), QStringLiteral("0.0000 mm"));
  d.clickPart(0, ui::PartsModel::Name);
  d.choose("unit-in");
  QCOMPARE(d.widget<QDoubleSpinBox>("positionX")->text(), QStringLiteral("0.87992 in"));
  d.type<QDoubleSpinBox>("positionX", "1");
  QVERIFY(std::abs(at().x - 0.0254) < 1e-15);
  d.choose("unit-mm");
  QCOMPARE(d.widget<QDoubleSpinBox>("positionX")->text(), QStringLiteral("25.4000 mm"));
}

/// They turned about the origin of the file, which may be far away: parts jumped.
void DesktopPartsTest::typedAnglesTurnAboutThePivot() {
  DesktopDriver d;
  d.addCubes();
  d.clickPart(1, ui::PartsModel::Name);
  const auto at = [&](const glm::dvec3& inPart) {
    return d.part("moving").worldFromPart.applyToPoint(inPart);
  };
  // The middle of the cube, 35 mm above the file's origin.
  const glm::dvec3 centre(0.0, 0.0, 0.035);
  d.type<QDoubleSpinBox>("rotationX", "45");
  QVERIFY(glm::distance(at(centre), centre) < 1e-12);
  QVERIFY(glm::distance(d.part("moving").worldFromPart.applyToVector({0, 1, 0}),
                        glm::dvec3(0.0, std::sqrt(0.5), std::sqrt(0.5))) < 1e-12);
  d.session().undo();
  const glm::dvec3 corner(0.01, 0.01, 0.045);
  d.session().setPivots({Session::NewPivot{d.partId("moving"), corner}});
  d.type<QDoubleSpinBox>("rotationZ", "90");
  QVERIFY(glm::distance(at(corner), corner) < 1e-12);
  QVERIFY(glm::distance(at(centre), glm::dvec3(0.02, 0.0, 0.035)) < 1e-12);
  // Keys turn about it too.
  d.type<QDoubleSpinBox>("turnStep", "30");
  pressInView(d, Qt::Key_Right, Qt::ShiftModifier);
  QVERIFY(glm::distance(at(corner), corner) < 1e-12);
}

void DesktopPartsTest::commandKeysWorkInANumberField() {
  DesktopDriver d;
  d.addCubes();
  d.clickPart(0, ui::PartsModel::Name);
  auto* field = d.widget<QDoubleSpinBox>("positionX");
  field->setFocus();
  // A line editor claims Ctrl+D for itself, to delete, and the number is not left by Return.
  field->selectAll();
  QTest::keyClicks(field, QStringLiteral("12.5"));
  QTest::keyClick(field, Qt::Key_D, Qt::ControlModifier);
  QCOMPARE(d.session().scene().parts().size(), std::size_t{3});
  for (const auto& part : d.session().scene().parts()) {
    const double expected = part->id == d.partId("moving") ? 0.0 : 0.0125;
    QVERIFY2(std::abs(part->worldFromPart.translation.x - expected) < 1e-15, part->name.c_str());
  }
}

void DesktopPartsTest::numbersLeftAloneStayExact() {
  DesktopDriver d;
  d.addCubes();
  const RigidTransform pose{glm::angleAxis(0.123456789, glm::dvec3(0, 0, 1)), {1.0 / 3.0, 0.1, 0.2}};
  d.session().movePart(d.partId("fixed"), pose);
  d.clickPart(0, ui::PartsModel::Name);
  d.type<QDoubleSpinBox>("positionZ", "7");
  QCOMPARE(d.part("fixed").worldFromPart.translation.x, pose.translation.x);
  QCOMPARE(d.part("fixed").worldFromPart.rotation.z, pose.rotation.z);
  QVERIFY(std::abs(d.part("fixed").worldFromPart.translation.z - 0.007) < 1e-15);
}

void DesktopPartsTest::densityMakesTheMass() {
  DesktopDriver d;
  d.addCubes();
  d.clickPart(1, ui::PartsModel::Name);
  // A cube of 20 mm, of water at first.
  QCOMPARE(d.text("mass"), QStringLiteral("8.00 g"));
  d.type<QDoubleSpinBox>("density", "7850");
  QCOMPARE(d.part("moving").density, 7850.0);
  QCOMPARE(d.text("mass"), QStringLiteral("62.8 g"));
  QCOMPARE(d.part("fixed").density, kDefaultDensity);
  d.session().undo();
  QCOMPARE(d.text("mass"), QStringLiteral("8.00 g"));
  d.session().setLocked(d.partId("fixed"), true);
  d.clickPart(0, ui::PartsModel::Name);
  QVERIFY(!d.widget<QDoubleSpinBox>("density")->isEnabled());
}

void DesktopPartsTest::deletesAndDuplicatesTheSelectedPart() {
  DesktopDriver d;
  d.addCubes();
  d.clickPart(0, ui::PartsModel::Name);
  pressShortcut(d, Qt::Key_D, Qt::ControlModifier);
  QCOMPARE(d.session().scene().parts().size(), std::size_t{3});
  d.clickPart(0, ui::PartsModel::Name);
  pressShortcut(d, Qt::Key_Delete);
  QVERIFY(d.session().scene().findByName("fixed") == nullptr);
  QCOMPARE(d.partsView()->model()->rowCount(), 2);
  pressShortcut(d, Qt::Key_Z, Qt::ControlModifier);
  QVERIFY(d.session().scene().findByName("fixed") != nullptr);
}

void DesktopPartsTest::clickInTheViewSelectsThePart() {
  DesktopDriver d;
  d.addCubes();
  d.session().setVisible(d.partId("moving"), false);
  ui::Viewport& view = d.window().viewport();
  d.choose("viewTop");
  QTest::qWait(100);
  QTest::mouseClick(&view, Qt::LeftButton, {}, view.rect().center());
  QCOMPARE(d.partsView()->currentIndex().row(), 0);
  QTest::mouseClick(&view, Qt::LeftButton, {}, QPoint(5, 60));
  QVERIFY(d.partsView()->selectionModel()->selectedRows().isEmpty());
}

void DesktopPartsTest::arrowKeysMoveTheSelectedPart() {
  DesktopDriver d;
  d.addCubes();
  d.clickPart(1, ui::PartsModel::Name);
  d.type<QDoubleSpinBox>("nudgeStep", "2");
  ui::Viewport& view = d.window().viewport();
  view.setFocus();
  QTest::keyClick(&view, Qt::Key_Right);
  QTest::keyClick(&view, Qt::Key_Up);
  QTest::keyClick(&view, Qt::Key_PageDown);
  const glm::dvec3 moved = d.part("moving").worldFromPart.translation;
  QVERIFY(glm::distance(moved, glm::dvec3(0.002, 0.002, -0.002)) < 1e-12);
}

void DesktopPartsTest::idleViewDrawsNothing() {
  DesktopDriver d;
  d.addCubes();
  QTRY_VERIFY(d.window().viewport().pictureCount() > 0);
  QVERIFY(d.comesToRest());
}

NEARFIT_QT_SUITE(DesktopPartsTest, runDesktopTest<DesktopPartsTest>)
#include "desktop_parts_test.moc"
