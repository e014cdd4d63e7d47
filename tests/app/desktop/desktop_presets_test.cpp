// Presets of how contact feels: chosen, made one's own, and kept from one run to the next.
#include <QComboBox>
#include <QDialog>
#include <QMessageBox>
#include <QStatusBar>
#include <QToolButton>
#include <fstream>

#include "core/scene/feel_preset.h"
#include "tests/app/desktop/desktop_driver.h"
#include "ui/model/preset_store.h"
#include "ui/widgets/number_field.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

struct PresetsFixture {
  QComboBox* panel() { return d.widget<QComboBox>("panelPreset"); }
  QComboBox* dialog() { return d.widget<QComboBox>("preset"); }
  const HapticSettings& settings() { return d.session().scene().haptics(); }
  /// By the keys, from wherever the list stands.
  void choose(QComboBox* box, const QString& name) {
    const int wanted = box->findText(name);
    QVERIFY(wanted >= 0);
    box->setFocus();
    // The last row is no choice: from there it goes up alone.
    for (int keys = 0; keys < box->count() && box->currentIndex() != wanted; ++keys)
      QTest::keyClick(box, box->currentIndex() < wanted ? Qt::Key_Down : Qt::Key_Up);
    QCOMPARE(box->currentText(), name);
  }
  /// Answers the question for a name as it comes.
  void nameIt(const char* action, const QString& name) {
    whenModal<QDialog>(
        [name](QDialog* question) {
          auto* field = question->findChild<QLineEdit*>(QStringLiteral("presetName"));
          field->selectAll();
          QTest::keyClicks(field, name);
          QTest::keyClick(field, Qt::Key_Return);
        },
        QStringLiteral("presetNameDialog"));
    manage(action);
  }
  /// By the menu of the button beside the presets.
  void manage(const char* action) {
    auto* button = d.window().findChild<QPushButton*>(QStringLiteral("presetMenu"));
    QMenu* menu = button->menu();
    // The button waits until its menu is gone.
    QTimer::singleShot(0, menu, [menu, entry = d.action(action)] {
      QVERIFY(QTest::qWaitFor([menu] { return menu->isVisible(); }));
      clickEntry(*menu, entry);
    });
    QTest::mouseClick(button, Qt::LeftButton);
  }
  void openDialog() {
    d.choose("feelSettings");
    QTRY_VERIFY(dialog()->isVisible());
  }

  DesktopDriver d;
};

}  // namespace

class DesktopPresetsTest : public QObject {
  Q_OBJECT

 private slots:
  void init() { std::filesystem::remove(ui::PresetStore::usualFile()); }
  void oneIsChosenAsOneStepOfUndoAndShownInBothPlaces();
  void whatIsChangedAfterwardsIsCustom();
  void onesOwnIsSavedChosenRenamedAndDeleted();
  void onesOwnIsThereInTheNextRun();
  void aUsualNameIsRefusedWithTheReason();
  void ofTwoThatFeelTheSameTheOneThatWasChosenIsShown();
  void aDamagedFileIsPutAsideAndTold();
};

void DesktopPresetsTest::oneIsChosenAsOneStepOfUndoAndShownInBothPlaces() {
  PresetsFixture f;
  QCOMPARE(f.panel()->currentText(), QStringLiteral("Stiff"));
  const std::size_t before = f.d.session().historyIndex();
  const HapticSettings stiff = f.settings();
  f.choose(f.panel(), QStringLiteral("Medium"));
  QCOMPARE(f.d.session().historyIndex(), before + 1);
  QCOMPARE(QString::fromStdString(f.d.session().undoText()), QStringLiteral("Feel settings: preset Medium"));
  QVERIFY(f.settings() == withPreset(stiff, usualFeelPresets()[1]));
  f.openDialog();
  QCOMPARE(f.dialog()->currentText(), QStringLiteral("Medium"));
  QCOMPARE(f.d.widget<ui::NumberField>("couplingStiffness")->quantity(), 600.0);
  f.choose(f.dialog(), QStringLiteral("Soft"));
  QCOMPARE(f.panel()->currentText(), QStringLiteral("Soft"));
  QCOMPARE(f.d.widget<ui::NumberField>("couplingStiffness")->quantity(), 250.0);
  QCOMPARE(f.d.session().historyIndex(), before + 2);
  f.d.choose("undo");
  QCOMPARE(f.dialog()->currentText(), QStringLiteral("Medium"));
  f.d.choose("undo");
  QCOMPARE(f.panel()->currentText(), QStringLiteral("Stiff"));
  QVERIFY(f.settings() == stiff);
}

void DesktopPresetsTest::whatIsChangedAfterwardsIsCustom() {
  PresetsFixture f;
  f.choose(f.panel(), QStringLiteral("Soft"));
  f.openDialog();
  f.d.type<ui::NumberField>("couplingStiffness", "260");
  QCOMPARE(f.panel()->currentText(), QStringLiteral("Custom"));
  QCOMPARE(f.dialog()->currentText(), QStringLiteral("Custom"));
  f.d.type<ui::NumberField>("couplingStiffness", "250");
  QCOMPARE(f.dialog()->currentText(), QStringLiteral("Soft"));
  // What belongs to the scene is no part of it.
  f.d.type<ui::NumberField>("cutoff", "7");
  QCOMPARE(f.dialog()->currentText(), QStringLiteral("Soft"));
}

void DesktopPresetsTest::onesOwnIsSavedChosenRenamedAndDeleted() {
  PresetsFixture f;
  f.openDialog();
  QVERIFY(!f.d.action("renamePreset")->isEnabled() && !f.d.action("deletePreset")->isEnabled());
  // Friction is no part of a usual one.
  f.d.type<ui::NumberField>("friction", "0.2");
  QCOMPARE(f.dialog()->currentText(), QStringLiteral("Stiff"));
  const std::string undo = f.d.session().undoText();
  f.nameIt("savePreset", QStringLiteral("Greasy steel"));
  QTRY_COMPARE(f.dialog()->currentText(), QStringLiteral("Greasy steel"));
  QCOMPARE(f.panel()->currentText(), QStringLiteral("Greasy steel"));
  QCOMPARE(f.d.session().undoText(), undo);
  keepPictures(*f.dialog()->window(), QStringLiteral("feel-settings"));
  f.d.type<ui::NumberField>("friction", "0");
  QCOMPARE(f.dialog()->currentText(), QStringLiteral("Stiff"));
  f.choose(f.panel(), QStringLiteral("Greasy steel"));
  QCOMPARE(f.settings().proxy.friction, 0.2);
  f.nameIt("renamePreset", QStringLiteral("Dry steel"));
  QTRY_COMPARE(f.panel()->currentText(), QStringLiteral("Dry steel"));
  QVERIFY(f.panel()->findText(QStringLiteral("Greasy steel")) < 0);
  const auto answer = [](const char* button) {
    whenModal<QMessageBox>(
        [button](QMessageBox* box) {
          auto* found = box->findChild<QPushButton*>(QLatin1String(button));
          QTest::mouseClick(found != nullptr ? found : box->button(QMessageBox::Cancel), Qt::LeftButton);
        },
        QStringLiteral("deletePresetBox"));
  };
  answer("cancel");
  f.manage("deletePreset");
  QCOMPARE(f.panel()->currentText(), QStringLiteral("Dry steel"));
  answer("confirmDeletePreset");
  f.manage("deletePreset");
  QCOMPARE(f.panel()->currentText(), QStringLiteral("Stiff"));
  QVERIFY(f.panel()->findText(QStringLiteral("Dry steel")) < 0);
  // The scene feels as it did.
  QCOMPARE(f.settings().proxy.friction, 0.2);
}

void DesktopPresetsTest::onesOwnIsThereInTheNextRun() {
  {
    PresetsFixture f;
    f.openDialog();
    f.d.type<ui::NumberField>("friction", "0.35");
    f.nameIt("savePreset", QStringLiteral("Gummi ½"));
    QTRY_COMPARE(f.panel()->currentText(), QStringLiteral("Gummi ½"));
  }
  PresetsFixture f;
  QCOMPARE(f.panel()->currentText(), QStringLiteral("Stiff"));
  f.choose(f.panel(), QStringLiteral("Gummi ½"));
  QCOMPARE(f.settings().proxy.friction, 0.35);
}

void DesktopPresetsTest::aUsualNameIsRefusedWithTheReason() {
  PresetsFixture f;
  f.openDialog();
  bool wasAsked = false;
  whenModal<QDialog>(
      [&](QDialog* question) {
        auto* field = question->findChild<QLineEdit*>(QStringLiteral("presetName"));
        auto* note = question->findChild<QLabel*>(QStringLiteral("presetNameNote"));
        auto* accept = question->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok);
        field->selectAll();
        QTest::keyClicks(field, QStringLiteral("soft"));
        QVERIFY(!accept->isEnabled());
        QVERIFY(note->text().contains(QStringLiteral("built-in")));
        keepPictures(*question, QStringLiteral("preset-name"));
        field->clear();
        QVERIFY(!accept->isEnabled());
        QTest::keyClicks(field, QStringLiteral("softer"));
        QVERIFY(accept->isEnabled() && note->text().isEmpty());
        wasAsked = true;
        QTest::keyClick(field, Qt::Key_Escape);
      },
      QStringLiteral("presetNameDialog"));
  f.manage("savePreset");
  QVERIFY(wasAsked);
  QVERIFY(!std::filesystem::exists(ui::PresetStore::usualFile()));
}

void DesktopPresetsTest::ofTwoThatFeelTheSameTheOneThatWasChosenIsShown() {
  PresetsFixture f;
  f.openDialog();
  f.nameIt("savePreset", QStringLiteral("As new"));
  QTRY_COMPARE(f.dialog()->currentText(), QStringLiteral("As new"));
  QVERIFY(f.d.action("deletePreset")->isEnabled());
  const std::size_t before = f.d.session().historyIndex();
  f.choose(f.panel(), QStringLiteral("Stiff"));
  QCOMPARE(f.dialog()->currentText(), QStringLiteral("Stiff"));
  QCOMPARE(f.d.session().historyIndex(), before);
}

void DesktopPresetsTest::aDamagedFileIsPutAsideAndTold() {
  const std::filesystem::path file = ui::PresetStore::usualFile();
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << "{\"format\": \"nearfit feel pres";
  PresetsFixture f;
  QVERIFY2(f.d.window().statusBar()->currentMessage().contains(QStringLiteral("could not be read")),
           qPrintable(f.d.window().statusBar()->currentMessage()));
  QCOMPARE(f.panel()->count(), 4);
  std::filesystem::path aside = file;
  aside.replace_extension(".damaged.json");
  QCOMPARE(readBytes(aside), std::string("{\"format\": \"nearfit feel pres"));
  // What is saved then is whole again.
  f.nameIt("savePreset", QStringLiteral("New"));
  QTRY_COMPARE(f.panel()->currentText(), QStringLiteral("New"));
  QCOMPARE(readFeelPresets(file).presets.size(), std::size_t{1});
  std::filesystem::remove(aside);
}

NEARFIT_QT_SUITE(DesktopPresetsTest, runDesktopTest<DesktopPresetsTest>)
#include "desktop_presets_test.moc"
