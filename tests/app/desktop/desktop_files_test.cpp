#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QMessageBox>
#include <QScrollArea>
#include <QScrollBar>

#include <nlohmann/json.hpp>

#include "tests/app/desktop/dialog_answers.h"
#include "ui/model/parts_model.h"

using namespace nearfit;
using namespace nearfit::test;

namespace {

/// Answers the question about unsaved changes.
void answerUnsaved(QMessageBox::StandardButton answer, bool& wasAsked) {
  wasAsked = false;
  whenModal<QMessageBox>([answer, &wasAsked](QMessageBox* box) {
    QCOMPARE(box->objectName(), QStringLiteral("unsavedBox"));
    QVERIFY2(box->button(answer)->text().startsWith(QChar('&')), "it has a key");
    wasAsked = true;
    QTest::mouseClick(box->button(answer), Qt::LeftButton);
  });
}

}  // namespace

class DesktopFilesTest : public QObject {
  Q_OBJECT

 private slots:
  void emptySceneOffersTheDemo();
  void emptySceneOffersTheScenesOpenedLast();
  void openTakesMeshesToo();
  void openReplacesTheSceneByThatOfAMesh();
  void savesAndOpensTheSameScene();
  void savingKeepsThePoseInHand();
  void savingKeepsANumberThatIsStillBeingTyped();
  void malformedSceneLosesNothingThatIsOpen();
  void closingAsksAboutChanges();
  void openingAsksAboutChanges();
  void aNewSceneAndTheDemoAskAboutChangesToo();
  void theFirstFileDialogOpensInTheDocuments();
  void exportsThePlacementInHand();
  void demoSceneOpensAndIsFelt();
};

void DesktopFilesTest::emptySceneOffersTheDemo() {
  DesktopDriver d;
  QVERIFY(d.widget<QWidget>("welcome")->isVisible());
  QVERIFY(d.widget<QPushButton>("openDemoButton")->isEnabled());
  d.addCubes();
  QVERIFY(!d.widget<QWidget>("welcome")->isVisible());
}

void DesktopFilesTest::emptySceneOffersTheScenesOpenedLast() {
  QSettings().remove(QStringLiteral("files/recent"));
  DesktopDriver d;
  QVERIFY(d.widget<QPushButton>("recent1") == nullptr);
  d.addCubes();
  const QString file = QString::fromStdString((d.folder.path() / "last.nearfit").string());
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, file); });
  pressShortcut(d, Qt::Key_S, Qt::ControlModifier);
  QTRY_VERIFY(QFile::exists(file));
  d.choose("newScene");
  auto* recent = d.widget<QPushButton>("recent1");
  QVERIFY(recent != nullptr && recent->isVisible());
  QCOMPARE(recent->text(), QStringLiteral("last.nearfit"));
  // There is room for it; it scrolled by the width of its border.
  QTRY_COMPARE(d.widget<QScrollArea>("welcomeScroll")->verticalScrollBar()->maximum(), 0);
  // Above a panel there is no room for all of the card: it scrolls.
  auto* card = d.widget<QWidget>("welcome");
  const QSize usual = d.window().size();
  chooseCommand(d.window(), panelEntry(d.widget<QDockWidget>("plotsDock")));
  d.window().resize(800, 464);
  QTRY_VERIFY(card->parentWidget()->height() < 300);
  QTRY_VERIFY(card->y() >= 0 && card->geometry().bottom() < card->parentWidget()->height());
  d.widget<QScrollArea>("welcomeScroll")->ensureWidgetVisible(recent);
  const auto seen = [&] { return QRect(recent->mapTo(card, QPoint()), recent->size()); };
  QTRY_VERIFY(seen().top() >= 0 && seen().bottom() <= card->height());
  d.widget<QDockWidget>("plotsDock")->close();
  d.window().resize(usual);
  QTest::mouseClick(recent, Qt::LeftButton);
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{2});
  QVERIFY(!d.widget<QWidget>("welcome")->isVisible());
}

/// It listed scenes alone.
void DesktopFilesTest::openTakesMeshesToo() {
  DesktopDriver d;
  DialogAnswers answers;
  QString filter;
  answers.expect(QStringLiteral("file"), [&](QDialog& dialog) {
    filter = qobject_cast<QFileDialog*>(&dialog)->nameFilters().constFirst();
    chooseFile(qobject_cast<QFileDialog*>(&dialog), d.fixedFile);
    return !dialog.isVisible();
  });
  // It takes no answer before the file has been read: a click that came too early left the dialog open for ever.
  answers.expectButton(QStringLiteral("unitDialog"), QDialogButtonBox::Ok);
  pressShortcut(d, Qt::Key_O, Qt::ControlModifier);
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{1});
  QCOMPARE(answers.faults(), QStringList());
  QVERIFY2(filter.contains(QStringLiteral("*.stl")), qPrintable(filter));
}

/// It added to the open scene, whose title stayed.
void DesktopFilesTest::openReplacesTheSceneByThatOfAMesh() {
  DesktopDriver d;
  d.addCubes();
  d.session().save(d.folder.path() / "pair.nearfit");
  d.session().deletePart(d.partId("moving"));
  const auto title = [&] { return d.window().windowTitle(); };
  QVERIFY2(title().contains(QStringLiteral("pair.nearfit")), qPrintable(title()));
  DialogAnswers answers;
  answers.expectFile(d.movingFile).expectButton(QStringLiteral("unsavedBox"), QDialogButtonBox::Cancel);
  pressShortcut(d, Qt::Key_O, Qt::ControlModifier);
  QCOMPARE(answers.faults(), QStringList());
  QVERIFY(!d.window().document().isBusy());
  QVERIFY(d.session().scene().findByName("fixed") != nullptr);

  // A question for the unit that is cancelled is as good.
  answers.expectFile(d.movingFile)
      .expectButton(QStringLiteral("unsavedBox"), QDialogButtonBox::Discard)
      .expectButton(QStringLiteral("unitDialog"), QDialogButtonBox::Cancel);
  pressShortcut(d, Qt::Key_O, Qt::ControlModifier);
  QCOMPARE(answers.faults(), QStringList());
  QVERIFY(!d.window().document().isBusy());
  QVERIFY(d.session().isModified() && d.session().canUndo());
  QVERIFY2(title().contains(QStringLiteral("pair.nearfit")), qPrintable(title()));

  answers.expectFile(d.movingFile)
      .expectButton(QStringLiteral("unsavedBox"), QDialogButtonBox::Discard)
      .expectButton(QStringLiteral("unitDialog"), QDialogButtonBox::Ok);
  pressShortcut(d, Qt::Key_O, Qt::ControlModifier);
  QTRY_VERIFY(d.session().scene().findByName("moving") != nullptr);
  QCOMPARE(answers.faults(), QStringList());
  QCOMPARE(d.session().scene().parts().size(), std::size_t{1});
  QVERIFY(d.session().file().empty());
  QVERIFY2(!title().contains(QStringLiteral("pair.nearfit")), qPrintable(title()));
  QVERIFY2(d.session().isModified(), "it is in no file");
  QVERIFY2(!d.session().canUndo(), "opening is no step, as with a scene file");

  // Parts are still added.
  d.add({d.fixedFile});
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{2});
}

void DesktopFilesTest::savesAndOpensTheSameScene() {
  DesktopDriver d;
  d.addCubes();
  const RigidTransform pose{glm::angleAxis(0.4, glm::normalize(glm::dvec3(1, 2, 3))), {0.01, -0.02, 0.5}};
  d.session().movePart(d.partId("fixed"), pose);
  const QString file = QString::fromStdString((d.folder.path() / "pair.nearfit").string());
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, file); });
  pressShortcut(d, Qt::Key_S, Qt::ControlModifier);
  QTRY_VERIFY(QFile::exists(file));
  QVERIFY(!d.window().isWindowModified());
  QVERIFY(d.window().windowTitle().contains(QStringLiteral("pair.nearfit")));

  pressShortcut(d, Qt::Key_N, Qt::ControlModifier);
  QVERIFY(d.session().scene().parts().empty());
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, file); });
  pressShortcut(d, Qt::Key_O, Qt::ControlModifier);
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{2});
  QVERIFY(glm::distance(d.part("fixed").worldFromPart.translation, pose.translation) < 1e-15);
  QVERIFY(std::abs(glm::dot(d.part("fixed").worldFromPart.rotation, pose.rotation)) > 1.0 - 1e-14);
  QCOMPARE(d.session().scene().movingPart(), std::optional(d.partId("moving")));
  QVERIFY(!d.window().isWindowModified());
}

void DesktopFilesTest::savingKeepsThePoseInHand() {
  DesktopDriver d;
  d.addCubes();
  const auto file = d.folder.path() / "held.nearfit";
  d.session().save(file);
  d.startWith(ui::Hand::Manual);
  d.clickPart(1, ui::PartsModel::Name);
  d.type<QDoubleSpinBox>("positionX", "2");
  QTRY_VERIFY(d.isFeltAtX(0.002));
  d.choose("save");
  QVERIFY(d.application.servo().isRunning());
  QVERIFY(std::abs(d.part("moving").worldFromPart.translation.x - 0.002) < 1e-12);
  QVERIFY(!d.window().isWindowModified());
}

void DesktopFilesTest::savingKeepsANumberThatIsStillBeingTyped() {
  DesktopDriver d;
  d.addCubes();
  d.session().save(d.folder.path() / "typed.nearfit");
  d.clickPart(0, ui::PartsModel::Name);
  auto* field = d.widget<QDoubleSpinBox>("positionX");
  field->setFocus();
  field->selectAll();
  QTest::keyClicks(field, QStringLiteral("2.5"));
  QTest::keyClick(field, Qt::Key_S, Qt::ControlModifier);
  QVERIFY(std::abs(d.part("fixed").worldFromPart.translation.x - 0.0025) < 1e-15);
  QVERIFY(!d.window().isWindowModified());
  const auto json = nlohmann::json::parse(readBytes(d.folder.path() / "typed.nearfit"));
  QVERIFY(std::abs(json.at("parts").at(0).at("position").at(0).get<double>() - 0.0025) < 1e-15);
  // Nor is it lost without a question when the window is closed.
  field->selectAll();
  QTest::keyClicks(field, QStringLiteral("3.5"));
  bool wasAsked = false;
  answerUnsaved(QMessageBox::Cancel, wasAsked);
  QVERIFY(!d.window().close());
  QVERIFY(wasAsked);
}

void DesktopFilesTest::malformedSceneLosesNothingThatIsOpen() {
  DesktopDriver d;
  d.addCubes();
  d.session().save(d.folder.path() / "good.nearfit");
  const auto broken = d.folder.write("broken.nearfit", "{\"format\": ");
  d.window().document().openScene(QString::fromStdString(broken.string()));
  QTRY_VERIFY(d.widget<QDialog>("errorBox") != nullptr);
  QVERIFY(d.text("errorDetails").contains(QStringLiteral("broken.nearfit")));
  QTest::keyClick(d.widget<QDialog>("errorBox"), Qt::Key_Return);
  QTRY_VERIFY(d.widget<QDialog>("errorBox") == nullptr);
  QCOMPARE(d.session().scene().parts().size(), std::size_t{2});
  QVERIFY(d.window().windowTitle().contains(QStringLiteral("good.nearfit")));
}

void DesktopFilesTest::closingAsksAboutChanges() {
  DesktopDriver d;
  QVERIFY2(d.window().close(), "nothing to lose, nothing to ask");
  d.window().show();
  d.addCubes();
  bool wasAsked = false;
  answerUnsaved(QMessageBox::Cancel, wasAsked);
  QVERIFY(!d.window().close());
  QVERIFY(wasAsked);
  QVERIFY(d.window().isVisible());
  answerUnsaved(QMessageBox::Discard, wasAsked);
  QVERIFY(d.window().close());
  QVERIFY(wasAsked);
}

void DesktopFilesTest::openingAsksAboutChanges() {
  DesktopDriver d;
  d.addCubes();
  const auto file = d.folder.path() / "two.nearfit";
  d.session().save(file);
  d.session().deletePart(d.partId("fixed"));
  bool wasAsked = false;
  answerUnsaved(QMessageBox::Cancel, wasAsked);
  d.window().document().openScene(QString::fromStdString(file.string()));
  QVERIFY(wasAsked);
  QCOMPARE(d.session().scene().parts().size(), std::size_t{1});
  answerUnsaved(QMessageBox::Discard, wasAsked);
  d.window().document().openScene(QString::fromStdString(file.string()));
  QTRY_COMPARE(d.session().scene().parts().size(), std::size_t{2});
}

void DesktopFilesTest::aNewSceneAndTheDemoAskAboutChangesToo() {
  DesktopDriver d;
  d.addCubes();
  bool wasAsked = false;
  for (const char* command : {"newScene", "openDemo"}) {
    answerUnsaved(QMessageBox::Cancel, wasAsked);
    d.choose(command);
    QVERIFY2(wasAsked, command);
    QVERIFY2(d.session().scene().findByName("moving") != nullptr, command);
  }
  answerUnsaved(QMessageBox::Discard, wasAsked);
  d.choose("openDemo");
  QVERIFY(wasAsked);
  QTRY_COMPARE_WITH_TIMEOUT(d.session().scene().parts().size(), std::size_t{4}, 10'000);
  // Nothing of the demo is lost that is not in its file.
  d.choose("newScene");
  QVERIFY(d.session().scene().parts().empty());
}

void DesktopFilesTest::theFirstFileDialogOpensInTheDocuments() {
  DesktopDriver d;
  QSettings().remove(QStringLiteral("files/folder"));
  const auto documents = d.folder.path() / "Papers";
  std::filesystem::create_directory(documents);
  const auto folders = "XDG_DOCUMENTS_DIR=\"" + documents.string() + "\"\n";
  d.folder.write("user-dirs.dirs", folders);
  const QByteArray before = qgetenv("XDG_CONFIG_HOME");
  qputenv("XDG_CONFIG_HOME", QByteArray::fromStdString(d.folder.path().string()));
  QString opened;
  whenModal<QFileDialog>([&](QFileDialog* dialog) {
    opened = dialog->directory().absolutePath();
    QTest::keyClick(dialog, Qt::Key_Escape);
  });
  d.choose("open");
  before.isNull() ? qunsetenv("XDG_CONFIG_HOME") : qputenv("XDG_CONFIG_HOME", before);
  QCOMPARE(opened, QString::fromStdString(documents.string()));
}

void DesktopFilesTest::exportsThePlacementInHand() {
  DesktopDriver d;
  d.addCubes();
  d.startWith(ui::Hand::Manual);
  d.clickPart(1, ui::PartsModel::Name);
  d.type<QDoubleSpinBox>("positionZ", "1.5");
  QTRY_COMPARE(d.text("statusDistance"), QStringLiteral("Min distance 6.50 mm"));
  const auto file = d.folder.path() / "placement.json";
  whenModal<QDialog>(
      [](QDialog* dialog) {
        QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Save),
                          Qt::LeftButton);
      },
      QStringLiteral("exportDialog"));
  whenModal<QFileDialog>(
      [&](QFileDialog* dialog) { chooseFile(dialog, QString::fromStdString(file.string())); });
  pressShortcut(d, Qt::Key_E, Qt::ControlModifier);
  QTRY_VERIFY(std::filesystem::exists(file));
  const auto json = nlohmann::json::parse(readBytes(file));
  QCOMPARE(QString::fromStdString(json.at("moving").get<std::string>()), QStringLiteral("moving"));
  bool found = false;
  for (const auto& part : json.at("parts")) {
    if (part.at("name") != "moving") continue;
    found = true;
    QVERIFY(std::abs(part.at("position").at(2).get<double>() - 0.0015) < 1e-12);
  }
  QVERIFY(found);
}

void DesktopFilesTest::demoSceneOpensAndIsFelt() {
  DesktopDriver d;
  QTest::mouseClick(d.widget<QPushButton>("openDemoButton"), Qt::LeftButton);
  QTRY_COMPARE_WITH_TIMEOUT(d.session().scene().parts().size(), std::size_t{4}, 10'000);
  QVERIFY(d.session().scene().movingPart());
  // Whoever tries things out and saves them writes over nothing: the file that others open is asked for anew.
  QVERIFY(d.session().file().empty());
  QVERIFY(!d.session().isModified());
  const QString mine = QString::fromStdString((d.folder.path() / "mine.nearfit").string());
  whenModal<QFileDialog>([&](QFileDialog* dialog) { chooseFile(dialog, mine); });
  d.clickPart(0, ui::PartsModel::Visible);
  QVERIFY(d.session().isModified());
  d.choose("save");
  QTRY_VERIFY(QFile::exists(mine));
  QCOMPARE(d.session().file(), std::filesystem::path(mine.toStdString()));
  d.startWith(ui::Hand::Scripted);
  QTRY_VERIFY(d.text("statusMinima").section(QChar(' '), 1, 1).toInt() > 10);
}

NEARFIT_QT_SUITE(DesktopFilesTest, runDesktopTest<DesktopFilesTest>)
#include "desktop_files_test.moc"
