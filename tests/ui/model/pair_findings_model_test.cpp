#include "ui/model/pair_findings_model.h"

#include <QApplication>
#include <QColor>
#include <QPalette>
#include <QtTest>

#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/qt/contrast.h"
#include "tests/support/qt/qt_suite.h"
#include "ui/widgets/length_unit.h"
#include "ui/widgets/theme.h"

using namespace nearfit;
using ui::PairFindingsModel;
using ui::ShownFinding;

namespace {

/// Three parts, and a check that found them so: "a" in "b", "a" near "c" and "b" touching "c", which a rule allows.
struct Found {
  Found() {
    const PartGeometryPtr box = test::geometryOf(test::boxMesh(glm::dvec3(0.02)));
    for (const char* name : {"a", "b", "c"})
      ids.push_back(scene.add(test::partOf(box, name)));
    check.parts = ids;
    check.rules = {{PairRuleKind::Touching, "b", "c"}};
    check.findings = {finding(0, 1, PairVerdict::Clash), finding(0, 2, PairVerdict::Near),
                      finding(1, 2, PairVerdict::Touching)};
    check.findings[0].clash.emplace();
    check.findings[0].clash->freeing = FreeingTranslation{0.0012, {1, 0, 0}};
    check.findings[0].clash->volumeProblem = VolumeProblem::Open;
    check.findings[1].distance = 0.0004;
    check.findings[2].allowedBy = 0;
    compare({});
  }
  PairFinding finding(std::size_t part, std::size_t other, PairVerdict verdict) const {
    PairFinding made;
    made.pair = {ids[part], ids[other]};
    made.verdict = verdict;
    return made;
  }
  void compare(const std::vector<PairRecord>& before) {
    compared = compareFindings(check, before);
    model.show(ui::shownFindings(scene, check, compared));
  }
  QString text(int row, int column) const { return model.index(row, column).data().toString(); }
  double rank(int row) const {
    return model.index(row, PairFindingsModel::Verdict).data(PairFindingsModel::kSortRole).toDouble();
  }

  Scene scene;
  std::vector<PartId> ids;
  SceneCheck check;
  std::vector<ComparedFinding> compared;
  PairFindingsModel model;
};

}  // namespace

class PairFindingsModelTest : public QObject {
  Q_OBJECT

 private slots:
  void verdictsAreReadableInBothThemes();
  void eachRowSaysWhatIsKnownOfAPair();
  void theWorstComeFirst();
  void whatIsGoneStaysInTheTableAsFixed();
  void whatWasAcceptedAndChangedIsToBeJudgedAgain();
  void whatAHiddenPartHadIsNotListed();
  void statesFollowTheScene();
  void rowsOfAnOldCheckAreGrey();
  void theSceneKeepsRowsOfItsLastCheck();
  void volumesAreInTheUnitThatIsChosen();
};

/// That of a clash had a contrast of 4.3 with white.
void PairFindingsModelTest::verdictsAreReadableInBothThemes() {
  const Found found;
  for (const auto scheme : {ui::ColourScheme::Light, ui::ColourScheme::Dark}) {
    ui::setColourScheme(scheme);
    const QPalette palette = QApplication::palette();
    for (const int row : {0, 1}) {
      const auto shown =
          found.model.index(row, PairFindingsModel::Verdict).data(Qt::ForegroundRole).value<QColor>();
      QVERIFY(shown.isValid());
      for (const auto ground : {QPalette::Base, QPalette::AlternateBase}) {
        const double contrast = test::contrast(shown, palette.color(ground));
        QVERIFY2(contrast >= 4.5, qPrintable(QStringLiteral("%1: %2").arg(shown.name()).arg(contrast)));
      }
    }
  }
  ui::setColourScheme(ui::ColourScheme::Light);
}

void PairFindingsModelTest::eachRowSaysWhatIsKnownOfAPair() {
  const Found f;
  QCOMPARE(f.model.rowCount(), 3);
  QCOMPARE(f.text(0, PairFindingsModel::First), QStringLiteral("a"));
  QCOMPARE(f.text(0, PairFindingsModel::Second), QStringLiteral("b"));
  QCOMPARE(f.text(0, PairFindingsModel::Verdict), QStringLiteral("clash"));
  QCOMPARE(f.text(0, PairFindingsModel::Depth), QStringLiteral("at most 1.20 mm"));
  QCOMPARE(f.text(0, PairFindingsModel::Volume), QStringLiteral("–"));
  const QString tip = f.model.index(0, PairFindingsModel::Volume).data(Qt::ToolTipRole).toString();
  QVERIFY2(tip.contains(QStringLiteral("a mesh is not closed")), qPrintable(tip));
  QCOMPARE(f.text(1, PairFindingsModel::Distance), QStringLiteral("0.40 mm"));
  QCOMPARE(f.text(1, PairFindingsModel::Depth), QStringLiteral("–"));
  QCOMPARE(f.text(2, PairFindingsModel::Verdict), QStringLiteral("touching, allowed"));
  QCOMPARE(f.text(2, PairFindingsModel::Change), QStringLiteral("new"));
  QCOMPARE(f.text(2, PairFindingsModel::State), QStringLiteral("new"));
}

void PairFindingsModelTest::theWorstComeFirst() {
  const Found f;
  QVERIFY(f.rank(0) > f.rank(1));
  // What is allowed comes after what is only near.
  QVERIFY(f.rank(1) > f.rank(2));
}

void PairFindingsModelTest::whatIsGoneStaysInTheTableAsFixed() {
  Found f;
  const PairRecord before{{f.ids[0], f.ids[1]}, PairVerdict::Clash, 0.0, 0.002, FindingState::New, {}};
  f.check.findings.erase(f.check.findings.begin());
  f.compare({before});
  QCOMPARE(f.model.rowCount(), 3);
  QCOMPARE(f.text(0, PairFindingsModel::Verdict), QStringLiteral("clear"));
  QCOMPARE(f.text(0, PairFindingsModel::Change), QStringLiteral("gone, was clash"));
  QCOMPARE(f.text(0, PairFindingsModel::State), QStringLiteral("fixed"));
  QVERIFY(f.model.at(0).now == nullptr);
  QVERIFY(f.rank(0) < f.rank(2));
}

void PairFindingsModelTest::whatWasAcceptedAndChangedIsToBeJudgedAgain() {
  Found f;
  f.compare({{{f.ids[0], f.ids[1]}, PairVerdict::Clash, 0.0, 0.001, FindingState::Accepted, "press fit"},
             {{f.ids[0], f.ids[2]}, PairVerdict::Touching, 0.0, {}, FindingState::Accepted, "guided"},
             {{f.ids[1], f.ids[2]}, PairVerdict::Touching, 0.0, {}, FindingState::Accepted, "stop"}});
  QCOMPARE(f.text(0, PairFindingsModel::Change), QStringLiteral("worse, was 1.00 mm"));
  QCOMPARE(f.text(0, PairFindingsModel::State), QStringLiteral("changed"));
  QCOMPARE(f.text(0, PairFindingsModel::Reason), QStringLiteral("press fit"));
  QCOMPARE(f.text(1, PairFindingsModel::Change), QStringLiteral("better, was touching"));
  QCOMPARE(f.text(1, PairFindingsModel::State), QStringLiteral("changed"));
  QCOMPARE(f.text(2, PairFindingsModel::Change), QStringLiteral("same"));
  QCOMPARE(f.text(2, PairFindingsModel::State), QStringLiteral("accepted"));
}

void PairFindingsModelTest::whatAHiddenPartHadIsNotListed() {
  Found f;
  const PairRecord before{{f.ids[0], f.ids[1]}, PairVerdict::Clash, 0.0, 0.002, FindingState::New, {}};
  f.check.findings.erase(f.check.findings.begin());
  f.check.parts.erase(f.check.parts.begin());
  f.compare({before});
  QCOMPARE(f.model.rowCount(), 2);
}

void PairFindingsModelTest::statesFollowTheScene() {
  Found f;
  QVERIFY(!f.model.at(0).isKept);
  const PairRecord record{{f.ids[0], f.ids[1]},   PairVerdict::Clash, 0.0, 0.0012,
                          FindingState::Accepted, "press fit"};
  f.scene.setPairRecords({record});
  const QSignalSpy changed(&f.model, &PairFindingsModel::dataChanged);
  f.model.follow(f.scene);
  QCOMPARE(changed.size(), 1);
  QVERIFY(f.model.at(0).isKept && !f.model.at(1).isKept);
  QCOMPARE(f.text(0, PairFindingsModel::State), QStringLiteral("accepted"));
  QCOMPARE(f.text(0, PairFindingsModel::Reason), QStringLiteral("press fit"));
  f.model.follow(f.scene);
  QVERIFY2(changed.size() == 1, "nothing is another");
}

void PairFindingsModelTest::rowsOfAnOldCheckAreGrey() {
  Found f;
  const auto colour = [&f](int column) {
    return f.model.index(0, column).data(Qt::ForegroundRole).value<QColor>();
  };
  QCOMPARE(colour(PairFindingsModel::Verdict), ui::themed(QColor(0xc8, 0x37, 0x2d)));
  f.model.setStale(true);
  for (int column = 0; column < PairFindingsModel::ColumnCount; ++column)
    QCOMPARE(colour(column), ui::themed(ui::colours::kMutedText));
}

void PairFindingsModelTest::theSceneKeepsRowsOfItsLastCheck() {
  Found f;
  f.scene.setPairRecords(
      {{{f.ids[0], f.ids[1]}, PairVerdict::Clash, 0.0, 0.0012, FindingState::Accepted, "press fit"},
       {{f.ids[0], f.ids[2]}, PairVerdict::Clear, 0.003, {}, FindingState::Fixed, ""}});
  f.model.show(ui::shownRecords(f.scene));
  QCOMPARE(f.model.rowCount(), 2);
  // How well the depth was known is not kept.
  QCOMPARE(f.text(0, PairFindingsModel::Depth), QStringLiteral("1.20 mm"));
  QCOMPARE(f.text(0, PairFindingsModel::Change), QStringLiteral("–"));
  QCOMPARE(f.text(0, PairFindingsModel::Reason), QStringLiteral("press fit"));
  QCOMPARE(f.text(1, PairFindingsModel::Distance), QStringLiteral("–"));
  QCOMPARE(f.text(1, PairFindingsModel::State), QStringLiteral("fixed"));
}

void PairFindingsModelTest::volumesAreInTheUnitThatIsChosen() {
  const ui::LengthUnit before = ui::shownLengthUnit();
  ui::setShownLengthUnit(ui::LengthUnit::Millimetre);
  QCOMPARE(ui::formatVolume(2e-9), QStringLiteral("2 mm³"));
  QCOMPARE(ui::formatVolume(2e-5), QStringLiteral("20 cm³"));
  QCOMPARE(ui::formatVolume(3.0), QStringLiteral("3 m³"));
  ui::setShownLengthUnit(ui::LengthUnit::Inch);
  QCOMPARE(ui::formatVolume(0.0254 * 0.0254 * 0.0254), QStringLiteral("1 in³"));
  ui::setShownLengthUnit(before);
}

NEARFIT_QT_SUITE(PairFindingsModelTest, test::runQtTest<PairFindingsModelTest>)
#include "pair_findings_model_test.moc"
