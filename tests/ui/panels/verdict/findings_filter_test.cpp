#include "ui/panels/verdict/findings_filter.h"

#include <QtTest>

#include "tests/support/qt/qt_suite.h"
#include "ui/model/pair_findings_model.h"

using namespace nearfit;
using ui::FindingsFilter;
using ui::ShownFinding;
using ui::VerdictFilter;

namespace {

ShownFinding finding(const char* part, PairVerdict verdict, FindingState state, const char* reason) {
  ShownFinding made;
  made.part = QString::fromLatin1(part);
  made.other = QStringLiteral("Housing");
  made.verdict = verdict;
  made.isForbidden = verdict >= PairVerdict::Clash && state == FindingState::New;
  made.state = state;
  made.reason = QString::fromLatin1(reason);
  return made;
}

/// Two clashes, of which one is accepted, one that is near and one that is gone.
struct Filtered {
  Filtered() {
    model.show({finding("Shaft", PairVerdict::Clash, FindingState::New, ""),
                finding("Bush", PairVerdict::Clash, FindingState::Accepted, "shrink fit"),
                finding("Cover", PairVerdict::Near, FindingState::New, ""),
                finding("Bolt", PairVerdict::Clear, FindingState::Fixed, "")});
    filter.setSourceModel(&model);
  }
  QStringList names() const {
    QStringList all;
    for (int row = 0; row < filter.rowCount(); ++row)
      all << filter.index(row, ui::PairFindingsModel::First).data().toString();
    return all;
  }

  ui::PairFindingsModel model;
  FindingsFilter filter;
};

}  // namespace

class FindingsFilterTest : public QObject {
  Q_OBJECT

 private slots:
  void textIsSoughtInNamesAndReasons();
  void verdictsAndStatesAreChosenTogether();
  void changesSinceTheLastCheckAreChosen();
};

void FindingsFilterTest::textIsSoughtInNamesAndReasons() {
  Filtered f;
  QCOMPARE(f.names().size(), 4);
  f.filter.setText(QStringLiteral(" sha"));
  QCOMPARE(f.names(), QStringList{QStringLiteral("Shaft")});
  f.filter.setText(QStringLiteral("SHRINK"));
  QCOMPARE(f.names(), QStringList{QStringLiteral("Bush")});
  f.filter.setText(QStringLiteral("housing"));
  QCOMPARE(f.names().size(), 4);
  f.filter.setText(QStringLiteral("nut"));
  QVERIFY(f.names().isEmpty());
}

void FindingsFilterTest::verdictsAndStatesAreChosenTogether() {
  Filtered f;
  f.filter.setVerdict(VerdictFilter::Clashing);
  QCOMPARE(f.names(), (QStringList{QStringLiteral("Shaft"), QStringLiteral("Bush")}));
  f.filter.setState(FindingState::Accepted);
  QCOMPARE(f.names(), QStringList{QStringLiteral("Bush")});
  f.filter.setVerdict(VerdictFilter::NotAllowed);
  QVERIFY(f.names().isEmpty());
  f.filter.setState(std::nullopt);
  QCOMPARE(f.names(), QStringList{QStringLiteral("Shaft")});
  f.filter.setVerdict(VerdictFilter::Near);
  QCOMPARE(f.names(), QStringList{QStringLiteral("Cover")});
  f.filter.setVerdict(VerdictFilter::Clear);
  QCOMPARE(f.names(), QStringList{QStringLiteral("Bolt")});
}

void FindingsFilterTest::changesSinceTheLastCheckAreChosen() {
  Filtered f;
  std::vector<ShownFinding> rows;
  const std::pair<const char*, std::optional<FindingChange>> changes[] = {
      {"New", FindingChange::New},       {"Worse", FindingChange::Worse}, {"Same", FindingChange::Same},
      {"Better", FindingChange::Better}, {"Gone", FindingChange::Gone},   {"Kept", std::nullopt}};
  for (const auto& [name, change] : changes) {
    rows.push_back(finding(name, PairVerdict::Near, FindingState::New, ""));
    rows.back().change = change;
  }
  f.model.show(rows);
  f.filter.setChange(ui::ChangeFilter::New);
  QCOMPARE(f.names(), QStringList{QStringLiteral("New")});
  f.filter.setChange(ui::ChangeFilter::Changed);
  QCOMPARE(f.names(), (QStringList{QStringLiteral("Worse"), QStringLiteral("Better")}));
  f.filter.setChange(ui::ChangeFilter::Gone);
  QCOMPARE(f.names(), QStringList{QStringLiteral("Gone")});
  f.filter.setChange(ui::ChangeFilter::All);
  QCOMPARE(f.names().size(), 6);
}

NEARFIT_QT_SUITE(FindingsFilterTest, test::runQtTest<FindingsFilterTest>)
#include "findings_filter_test.moc"
