#include <QComboBox>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QProgressBar>
#include <QTableView>
#include <filesystem>

#include "core/scene/scene_file.h"
#include "tests/app/desktop/desktop_driver.h"
#include "tests/app/desktop/dialog_answers.h"
#include "tests/app/desktop/row_highlight.h"
#include "ui/model/pair_findings_model.h"
#include "ui/panels/verdict/findings_filter.h"

using namespace nearfit;
using namespace nearfit::test;
using ui::PairFindingsModel;

namespace {

/// The cube of 40 mm, that of 20 mm whose face is 5 mm above it, and a plug of 20 mm that is 5 mm deep in the
/// side of the first. All are checked with a threshold of 10 mm: the first two are near, the second and the
/// plug are 15.8 mm apart.
struct SceneCheckFixture {
  SceneCheckFixture() {
    d.addCubes();
    const QString plug =
        writeOff(d.folder.path() / "plug.off", boxMesh(glm::dvec3(0.02), glm::dvec3(0.025, 0.0, 0.0)));
    d.add({plug});
    (void)QTest::qWaitFor([&] { return d.session().scene().parts().size() == 3; });
    d.choose("checkScene");
    table = d.widget<QTableView>("sceneCheckTable");
    (void)QTest::qWaitFor([&] { return table->isVisible(); });
    d.type<QDoubleSpinBox>("sceneCheckThreshold", "10 mm");
  }
  void press(const char* button) { QTest::mouseClick(d.widget<QPushButton>(button), Qt::LeftButton); }
  /// Checks the scene and waits for the result.
  void check() {
    press("runSceneCheck");
    QTRY_VERIFY(d.widget<QPushButton>("runSceneCheck")->isEnabled());
  }
  QString cell(int row, int column) const { return table->model()->index(row, column).data().toString(); }
  /// A cell of the row with these parts, the older one first.
  QString of(const char* part, const char* other, int column) const {
    for (int row = 0; row < table->model()->rowCount(); ++row) {
      if (cell(row, PairFindingsModel::First) == QLatin1String(part) &&
          cell(row, PairFindingsModel::Second) == QLatin1String(other))
        return cell(row, column);
    }
    return {};
  }
  void clickRow(int row) {
    const QModelIndex index = table->model()->index(row, PairFindingsModel::Verdict);
    table->scrollTo(index);
    QTest::mouseClick(table->viewport(), Qt::LeftButton, {}, table->visualRect(index).center());
  }
  QString summary() { return d.text("sceneCheckSummary"); }
  /// Adds so many cubes in a row, 0.1 m apart.
  void addCubes(int count) {
    const PartGeometryPtr cube = d.session().scene().get(d.partId("moving")).geometry;
    NewNodes more;
    for (int i = 1; i <= count; ++i)
      more.parts.push_back({cube, "cube " + std::to_string(i), {{1, 0, 0, 0}, {0.1 * i, 0.0, 0.0}}});
    d.session().addNodes(more);
  }
  /// Answers the dialog for a reason.
  static bool giveReason(QDialog& dialog) {
    auto* reason = dialog.findChild<QLineEdit*>(QStringLiteral("acceptReason"));
    auto* accept = dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok);
    if (accept->isEnabled()) return false;
    QTest::keyClicks(reason, QStringLiteral("glued"));
    QTest::mouseClick(accept, Qt::LeftButton);
    return true;
  }

  DesktopDriver d;
  QTableView* table = nullptr;
};

}  // namespace

class DesktopSceneCheckTest : public QObject {
  Q_OBJECT

 private slots:
  void theTableSaysWhichPairsClashAndWhichAreNear();
  void namesAreShownWhole();
  void theNoteAndTheStatesNeedNoScrolling();
  void aRowHighlightsItsPairAndMarksThePlace();
  void aPairIsShownUntilTheNextSelectionOrEscape();
  void returnGoesToThePlace();
  void aFindingIsAcceptedWithAReasonAsAStepToUndo();
  void theNextCheckSaysWhatHasChanged();
  void rulesLeavePairsOutAndAllowOthers();
  void rulesOfEachKindAreChosenAndRemoved();
  void aRuleForAPairNamesItsParts();
  void theResultIsOldOnceTheSceneChanges();
  void theTableIsFilteredByTextVerdictAndState();
  void theTableIsFilteredByChange();
  void aClickOnAHeadSortsTheTable();
  void aCheckThatIsCancelledLeavesTheButtonForAnother();
  void aLongCheckSaysHowFarItIsAndCanBeCancelled();
  void findingsAreKeptInTheSceneFile();
  void findingsBeyondTheLimitOfASceneAreTold();
  void theTableIsExportedAsCsvAndJson();
  void theSceneIsCheckedWhileAPartIsFelt();
  void aHiddenPanelMarksNothing();
};

void DesktopSceneCheckTest::theTableSaysWhichPairsClashAndWhichAreNear() {
  SceneCheckFixture f;
  QVERIFY(f.summary().contains(QStringLiteral("not checked yet")));
  QVERIFY(!f.d.widget<QPushButton>("exportSceneCheck")->isEnabled());
  f.check();
  QCOMPARE(f.summary(), QStringLiteral("1 clash, 1 near, 1 clear"));
  QCOMPARE(f.table->model()->rowCount(), 2);
  // The worst comes first.
  QCOMPARE(f.cell(0, PairFindingsModel::Second), QStringLiteral("plug"));
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::Verdict), QStringLiteral("clash"));
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::Depth), QStringLiteral("5.00 mm"));
  // 5 mm x 20 mm x 20 mm.
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::Volume), QStringLiteral("2000 mm³"));
  QCOMPARE(f.of("fixed", "moving", PairFindingsModel::Verdict), QStringLiteral("near"));
  QCOMPARE(f.of("fixed", "moving", PairFindingsModel::Distance), QStringLiteral("5.00 mm"));
  f.d.choose("unit-in");
  QCOMPARE(f.of("fixed", "moving", PairFindingsModel::Distance), QStringLiteral("0.197 in"));
  f.d.choose("unit-mm");
  keepPictures(f.d.window(), QStringLiteral("scene-check"));
}

void DesktopSceneCheckTest::namesAreShownWhole() {
  SceneCheckFixture f;
  f.d.session().renamePart(f.d.partId("fixed"), "Gearbox housing, lower");
  f.d.session().renamePart(f.d.partId("moving"), "Bearing cover, left");
  f.d.session().renamePart(f.d.partId("plug"), "Drain plug M12");
  f.check();
  const auto areWhole = [&f] {
    const int margin = f.table->style()->pixelMetric(QStyle::PM_FocusFrameHMargin, nullptr, f.table) + 1;
    for (int row = 0; row < f.table->model()->rowCount(); ++row) {
      for (const int column : {PairFindingsModel::First, PairFindingsModel::Second}) {
        const QString name = f.cell(row, column);
        const int width = f.table->columnWidth(column) - 2 * margin;
        if (f.table->fontMetrics().elidedText(name, Qt::ElideRight, width) != name) return false;
      }
    }
    return true;
  };
  QCOMPARE(f.table->model()->rowCount(), 2);
  QVERIFY(areWhole());
  keepPictures(f.d.window(), QStringLiteral("scene-check-names"));
  // The next result leaves the columns as they are.
  std::vector<int> widths;
  for (int column = 0; column < PairFindingsModel::ColumnCount; ++column)
    widths.push_back(f.table->columnWidth(column));
  f.d.session().movePart(f.d.partId("Drain plug M12"), {{1, 0, 0, 0}, {0.08, 0.0, 0.0}});
  f.check();
  for (const int column : {PairFindingsModel::First, PairFindingsModel::Second, PairFindingsModel::Verdict})
    QVERIFY(f.table->columnWidth(column) <= widths[static_cast<std::size_t>(column)]);
  QVERIFY(areWhole());
}

/// The note was squeezed beside five buttons, and the states were behind a scroll bar.
void DesktopSceneCheckTest::theNoteAndTheStatesNeedNoScrolling() {
  SceneCheckFixture f;
  f.check();
  f.clickRow(0);
  auto* note = f.d.widget<QLabel>("sceneCheckNote");
  QTRY_COMPARE(note->width(), f.table->width());
  QVERIFY(note->heightForWidth(note->width()) < 2 * note->fontMetrics().lineSpacing());
  const int end = f.table->horizontalHeader()->sectionPosition(PairFindingsModel::State) +
                  f.table->columnWidth(PairFindingsModel::State);
  QVERIFY2(end <= f.table->viewport()->width(), qPrintable(QString::number(end)));
}

void DesktopSceneCheckTest::aRowHighlightsItsPairAndMarksThePlace() {
  SceneCheckFixture f;
  f.check();
  const auto selected = f.d.window().selection().parts();
  f.clickRow(0);
  QVERIFY(f.d.text("sceneCheckNote").startsWith(QStringLiteral("The arrow")));
  auto* label = f.d.window().viewport().findChild<QLabel*>(QStringLiteral("pairLabel"));
  QTRY_VERIFY(label->isVisible());
  QCOMPARE(label->text(), QStringLiteral("depth 5.00 mm"));
  const QImage with = f.d.picture();
  QVERIFY2(f.d.window().selection().parts() == selected, "the selection is the user's");
  f.table->clearSelection();
  QVERIFY(!label->isVisible());
  QVERIFY(differentPixels(f.d.picture(), with) > 100);
  f.clickRow(1);
  QTRY_COMPARE(label->text(), QStringLiteral("5.00 mm"));
  keepPictures(f.d.window(), QStringLiteral("scene-check-near"));
}

/// Its parts stayed highlighted.
void DesktopSceneCheckTest::aPairIsShownUntilTheNextSelectionOrEscape() {
  SceneCheckFixture f;
  f.check();
  auto* label = f.d.window().viewport().findChild<QLabel*>(QStringLiteral("pairLabel"));
  checkThatAPairIsShownUntilTheNextSelectionOrEscape(f.d, {*f.table, *label, [&f] { f.clickRow(0); }},
                                                     "fixed", "moving");
}

void DesktopSceneCheckTest::returnGoesToThePlace() {
  SceneCheckFixture f;
  f.check();
  f.clickRow(0);
  QTest::keyClick(f.table, Qt::Key_Return);
  // They meet in a square of 20 mm about x = 20 mm, and the arrow is 5 mm long.
  const glm::dvec3 middle(0.02, 0.0, 0.0);
  const auto isInTheMiddle = [&] {
    const auto seen = f.d.window().viewport().projection().pixelOf(middle);
    const QSize size = f.d.window().viewport().size();
    return seen && std::abs(seen->x / size.width() - 0.5) < 0.25 &&
           std::abs(seen->y / size.height() - 0.5) < 0.25;
  };
  QTRY_VERIFY(isInTheMiddle());
}

void DesktopSceneCheckTest::aFindingIsAcceptedWithAReasonAsAStepToUndo() {
  SceneCheckFixture f;
  f.check();
  QVERIFY(!f.d.widget<QPushButton>("acceptFinding")->isEnabled());
  f.clickRow(0);
  DialogAnswers answers;
  answers.expect(QStringLiteral("acceptDialog"), &SceneCheckFixture::giveReason);
  f.press("acceptFinding");
  QVERIFY2(answers.faults().isEmpty(), qPrintable(answers.faults().join(' ')));
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::State), QStringLiteral("accepted"));
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::Reason), QStringLiteral("glued"));
  f.d.session().undo();
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::State), QStringLiteral("new"));
  f.d.session().redo();
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::State), QStringLiteral("accepted"));
  f.press("reopenFinding");
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::State), QStringLiteral("new"));
  f.press("fixFinding");
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::State), QStringLiteral("fixed"));
}

void DesktopSceneCheckTest::theNextCheckSaysWhatHasChanged() {
  SceneCheckFixture f;
  f.check();
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::Change), QStringLiteral("new"));
  const PartId plug = f.d.partId("plug");
  f.d.session().movePart(plug, {{1, 0, 0, 0}, {-0.001, 0.0, 0.0}});
  f.check();
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::Change), QStringLiteral("worse, was 5.00 mm"));
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::Depth), QStringLiteral("6.00 mm"));
  QCOMPARE(f.of("fixed", "moving", PairFindingsModel::Change), QStringLiteral("same"));
  // 75 mm from the first, and farther from the other.
  f.d.session().movePart(plug, {{1, 0, 0, 0}, {0.08, 0.0, 0.0}});
  f.check();
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::Change), QStringLiteral("gone, was clash"));
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::State), QStringLiteral("fixed"));
  QCOMPARE(f.summary(), QStringLiteral("no clash, 1 near, 2 clear"));
}

void DesktopSceneCheckTest::rulesLeavePairsOutAndAllowOthers() {
  SceneCheckFixture f;
  DialogAnswers answers;
  answers.expect(QStringLiteral("rulesDialog"), [](QDialog& dialog) {
    auto* buttons = dialog.findChild<QDialogButtonBox*>();
    const auto child = [&dialog](const char* name) {
      return dialog.findChild<QLineEdit*>(QLatin1String(name));
    };
    QTest::mouseClick(dialog.findChild<QPushButton*>(QStringLiteral("addRule")), Qt::LeftButton);
    child("rulePart")->setText(QString());
    // A pattern must not be empty.
    if (buttons->button(QDialogButtonBox::Ok)->isEnabled()) return false;
    child("rulePart")->setText(QStringLiteral("mov*"));
    child("ruleOther")->setText(QStringLiteral("fixed"));
    QTest::mouseClick(dialog.findChild<QPushButton*>(QStringLiteral("addRule")), Qt::LeftButton);
    auto* kind = dialog.findChild<QComboBox*>(QStringLiteral("ruleKind"));
    kind->setFocus();
    QTest::keyClick(kind, Qt::Key_End);
    child("rulePart")->setText(QStringLiteral("plug"));
    child("ruleOther")->setText(QStringLiteral("fixed"));
    auto* depth = dialog.findChild<QDoubleSpinBox*>(QStringLiteral("ruleInterference"));
    depth->setFocus();
    depth->selectAll();
    QTest::keyClicks(depth, QStringLiteral("6 mm"));
    QTest::mouseClick(buttons->button(QDialogButtonBox::Ok), Qt::LeftButton);
    return true;
  });
  f.press("sceneCheckRules");
  QVERIFY2(answers.faults().isEmpty(), qPrintable(answers.faults().join(' ')));
  const std::vector<PairRule> wanted{{PairRuleKind::LeaveOut, "mov*", "fixed"},
                                     {PairRuleKind::PressFit, "plug", "fixed", 0.006}};
  QVERIFY(f.d.session().scene().pairRules() == wanted);
  f.check();
  QCOMPARE(f.summary(), QStringLiteral("1 clash (1 allowed), 1 clear; 1 left out by rules"));
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::Verdict), QStringLiteral("clash, allowed"));
  f.d.session().undo();
  QVERIFY2(f.d.session().scene().pairRules().empty(), "the rules are one step, the check none");
}

void DesktopSceneCheckTest::rulesOfEachKindAreChosenAndRemoved() {
  SceneCheckFixture f;
  DialogAnswers answers;
  answers.expect(QStringLiteral("rulesDialog"), [](QDialog& dialog) {
    auto* kind = dialog.findChild<QComboBox*>(QStringLiteral("ruleKind"));
    auto* list = dialog.findChild<QListWidget*>(QStringLiteral("ruleList"));
    auto* remove = dialog.findChild<QPushButton*>(QStringLiteral("removeRule"));
    const auto add = [&](int kindsDown) {
      QTest::mouseClick(dialog.findChild<QPushButton*>(QStringLiteral("addRule")), Qt::LeftButton);
      kind->setFocus();
      for (int i = 0; i < kindsDown; ++i)
        QTest::keyClick(kind, Qt::Key_Down);
    };
    const auto name = [&](const char* part, const char* other) {
      dialog.findChild<QLineEdit*>(QStringLiteral("rulePart"))->setText(QLatin1String(part));
      dialog.findChild<QLineEdit*>(QStringLiteral("ruleOther"))->setText(QLatin1String(other));
    };
    if (remove->isEnabled()) return false;
    add(0);
    name("plug", "fixed");
    add(1);
    // Parts of one group need no names.
    if (dialog.findChild<QLineEdit*>(QStringLiteral("rulePart"))->isEnabled()) return false;
    add(2);
    name("mov*", "fixed");
    list->setCurrentRow(0);
    QTest::mouseClick(remove, Qt::LeftButton);
    if (list->count() != 2) return false;
    QTest::mouseClick(dialog.findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok), Qt::LeftButton);
    return true;
  });
  f.press("sceneCheckRules");
  QVERIFY2(answers.faults().isEmpty(), qPrintable(answers.faults().join(' ')));
  const std::vector<PairRule> wanted{{PairRuleKind::SameGroup, "*", "*"},
                                     {PairRuleKind::Touching, "mov*", "fixed"}};
  QVERIFY(f.d.session().scene().pairRules() == wanted);
  f.check();
  QVERIFY2(f.summary().startsWith(QStringLiteral("1 clash, 1 near, 1 clear")), qPrintable(f.summary()));
}

void DesktopSceneCheckTest::aRuleForAPairNamesItsParts() {
  SceneCheckFixture f;
  f.check();
  f.clickRow(0);
  DialogAnswers answers;
  answers.expectButton(QStringLiteral("rulesDialog"), QDialogButtonBox::Ok);
  f.press("ruleForPair");
  QVERIFY2(answers.faults().isEmpty(), qPrintable(answers.faults().join(' ')));
  const std::vector<PairRule> wanted{{PairRuleKind::LeaveOut, "fixed", "plug"}};
  QVERIFY(f.d.session().scene().pairRules() == wanted);
  f.check();
  QCOMPARE(f.summary(), QStringLiteral("no clash, 1 near, 1 clear; 1 left out by rules"));
}

void DesktopSceneCheckTest::theResultIsOldOnceTheSceneChanges() {
  SceneCheckFixture f;
  f.check();
  const QString counts = f.summary();
  const auto colour = [&f] {
    return f.table->model()->index(0, PairFindingsModel::First).data(Qt::ForegroundRole);
  };
  QVERIFY(!colour().isValid());
  f.d.session().setColour(f.d.partId("plug"), Colour{0, 1, 0});
  QVERIFY2(!colour().isValid(), "its colour does not matter");
  f.d.session().movePart(f.d.partId("plug"), {{1, 0, 0, 0}, {0.001, 0.0, 0.0}});
  QVERIFY(colour().isValid());
  QVERIFY(f.summary() != counts && f.summary().startsWith(counts));
  QVERIFY(f.d.text("sceneCheckNote").contains(QStringLiteral("check it again")));
  f.d.session().undo();
  QVERIFY2(!colour().isValid(), "it is as it was");
  QCOMPARE(f.summary(), counts);
  f.d.session().setVisible(f.d.partId("plug"), false);
  QVERIFY(colour().isValid());
}

void DesktopSceneCheckTest::theTableIsFilteredByTextVerdictAndState() {
  SceneCheckFixture f;
  f.check();
  auto* text = f.d.widget<QLineEdit>("sceneCheckText");
  QTest::keyClicks(text, QStringLiteral("PLUG"));
  QCOMPARE(f.table->model()->rowCount(), 1);
  text->clear();
  auto* verdicts = f.d.widget<QComboBox>("sceneCheckVerdicts");
  verdicts->setCurrentIndex(verdicts->findData(static_cast<int>(ui::VerdictFilter::Near)));
  QCOMPARE(f.table->model()->rowCount(), 1);
  QCOMPARE(f.cell(0, PairFindingsModel::Second), QStringLiteral("moving"));
  auto* states = f.d.widget<QComboBox>("sceneCheckStates");
  states->setCurrentIndex(states->findData(static_cast<int>(FindingState::Accepted)));
  QCOMPARE(f.table->model()->rowCount(), 0);
  QVERIFY(f.d.text("sceneCheckNote").startsWith(QStringLiteral("No finding")));
}

void DesktopSceneCheckTest::theTableIsFilteredByChange() {
  SceneCheckFixture f;
  f.check();
  f.d.session().movePart(f.d.partId("plug"), {{1, 0, 0, 0}, {-0.001, 0.0, 0.0}});
  f.check();
  auto* changes = f.d.widget<QComboBox>("sceneCheckChanges");
  changes->setCurrentIndex(changes->findData(static_cast<int>(ui::ChangeFilter::Changed)));
  QCOMPARE(f.table->model()->rowCount(), 1);
  QCOMPARE(f.cell(0, PairFindingsModel::Second), QStringLiteral("plug"));
  changes->setCurrentIndex(changes->findData(static_cast<int>(ui::ChangeFilter::New)));
  QCOMPARE(f.table->model()->rowCount(), 0);
  changes->setCurrentIndex(changes->findData(static_cast<int>(ui::ChangeFilter::All)));
  QCOMPARE(f.table->model()->rowCount(), 2);
}

void DesktopSceneCheckTest::aClickOnAHeadSortsTheTable() {
  SceneCheckFixture f;
  f.check();
  QHeaderView& head = *f.table->horizontalHeader();
  const auto click = [&head] {
    const int at = head.sectionViewportPosition(PairFindingsModel::Second);
    QTest::mouseClick(head.viewport(), Qt::LeftButton, {}, {at + 10, head.height() / 2});
  };
  QCOMPARE(f.cell(0, PairFindingsModel::Second), QStringLiteral("plug"));
  click();
  const QString first = f.cell(0, PairFindingsModel::Second);
  click();
  const QString second = f.cell(0, PairFindingsModel::Second);
  QVERIFY2(first != second, qPrintable(first));
  QCOMPARE(QStringList({first, second}).join(' ').contains(QStringLiteral("moving")), true);
}

void DesktopSceneCheckTest::aCheckThatIsCancelledLeavesTheButtonForAnother() {
  SceneCheckFixture f;
  auto* cancel = f.d.widget<QPushButton>("cancelSceneCheck");
  QVERIFY(!cancel->isVisible());
  f.press("runSceneCheck");
  QVERIFY(cancel->isVisible());
  f.press("cancelSceneCheck");
  QTRY_VERIFY(!cancel->isVisible());
  // It may have ended just before it was cancelled.
  QVERIFY(f.summary() == QStringLiteral("Cancelled.") ||
          f.summary() == QStringLiteral("1 clash, 1 near, 1 clear"));
  f.check();
  QCOMPARE(f.summary(), QStringLiteral("1 clash, 1 near, 1 clear"));
}

void DesktopSceneCheckTest::aLongCheckSaysHowFarItIsAndCanBeCancelled() {
  SceneCheckFixture f;
  f.addCubes(600);
  f.d.type<QDoubleSpinBox>("sceneCheckThreshold", "100 m");
  f.press("runSceneCheck");
  auto* progress = f.d.widget<QProgressBar>("sceneCheckProgress");
  QVERIFY(progress->isVisible());
  QTRY_VERIFY(progress->value() > progress->minimum());
  f.press("cancelSceneCheck");
  QTRY_VERIFY(!f.d.widget<QPushButton>("cancelSceneCheck")->isVisible());
  QCOMPARE(f.summary(), QStringLiteral("Cancelled."));
  QVERIFY(!progress->isVisible());
  QCOMPARE(f.table->model()->rowCount(), 0);
}

void DesktopSceneCheckTest::findingsAreKeptInTheSceneFile() {
  SceneCheckFixture f;
  f.check();
  f.d.session().setFindingState({{f.d.partId("fixed"), f.d.partId("plug")}}, FindingState::Accepted, "glued");
  const auto file = f.d.folder.path() / "kept.nearfit";
  f.d.session().save(file);
  f.d.session().reset(readSceneFile(file), file);
  QTRY_COMPARE(f.of("fixed", "plug", PairFindingsModel::State), QStringLiteral("accepted"));
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::Reason), QStringLiteral("glued"));
  QCOMPARE(f.summary(), QStringLiteral("Findings of the last check: 2"));
  QVERIFY(!f.d.session().isModified());
  f.check();
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::Change), QStringLiteral("same"));
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::State), QStringLiteral("accepted"));
}

/// They were left out of the scene without a word.
void DesktopSceneCheckTest::findingsBeyondTheLimitOfASceneAreTold() {
  SceneCheckFixture f;
  // With the three that are there 202 parts, of which all 20,301 pairs are within the threshold.
  f.addCubes(199);
  f.d.type<QDoubleSpinBox>("sceneCheckThreshold", "100 m");
  f.check();
  QCOMPARE(f.table->model()->rowCount(), 20'301);
  QCOMPARE(f.d.session().scene().pairRecords().size(), kMaxPairRecords);
  const QString note = f.d.text("sceneCheckNote");
  QVERIFY2(note.contains(QStringLiteral("301 of the least cannot be accepted")), qPrintable(note));
}

void DesktopSceneCheckTest::theTableIsExportedAsCsvAndJson() {
  SceneCheckFixture f;
  f.check();
  f.d.session().setFindingState({{f.d.partId("fixed"), f.d.partId("plug")}}, FindingState::Accepted, "glued");
  const auto csv = f.d.folder.path() / "check.csv", json = f.d.folder.path() / "check.json";
  for (const auto& file : {csv, json}) {
    DialogAnswers answers;
    answers.expectFile(QString::fromStdString(file.string()));
    f.press("exportSceneCheck");
    QVERIFY2(answers.faults().isEmpty(), qPrintable(answers.faults().join(' ')));
    QTRY_VERIFY(std::filesystem::exists(file));
    QTRY_VERIFY(f.d.widget<QPushButton>("exportSceneCheck")->isEnabled());
  }
  const std::string rows = readBytes(csv);
  QVERIFY(rows.starts_with("part,other,verdict,"));
  QVERIFY2(rows.find("\nfixed,plug,clash,0,,accepted,new,glued,") != std::string::npos, rows.c_str());
  QVERIFY(readBytes(json).find("\"nearfitCheck\": 1") != std::string::npos);
}

void DesktopSceneCheckTest::theSceneIsCheckedWhileAPartIsFelt() {
  SceneCheckFixture f;
  f.d.startWith(ui::Hand::Manual);
  f.check();
  QCOMPARE(f.of("fixed", "plug", PairFindingsModel::Verdict), QStringLiteral("clash"));
  QVERIFY2(f.d.application.servo().isRunning(), "it goes on");
}

void DesktopSceneCheckTest::aHiddenPanelMarksNothing() {
  SceneCheckFixture f;
  f.check();
  f.clickRow(0);
  auto* label = f.d.window().viewport().findChild<QLabel*>(QStringLiteral("pairLabel"));
  QTRY_VERIFY(label->isVisible());
  auto* dock = f.d.widget<QDockWidget>("sceneCheckDock");
  f.d.choose(panelEntry(dock));
  QTRY_VERIFY(!label->isVisible());
  f.d.choose(panelEntry(dock));
  QTRY_VERIFY(label->isVisible());
}

NEARFIT_QT_SUITE(DesktopSceneCheckTest, runDesktopTest<DesktopSceneCheckTest>)
#include "desktop_scene_check_test.moc"
