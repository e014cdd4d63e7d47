#include "ui/panels/verdict/findings_filter.h"

#include "ui/model/pair_findings_model.h"

namespace nearfit::ui {
namespace {

bool isShownBy(VerdictFilter filter, const ShownFinding& row) {
  switch (filter) {
    case VerdictFilter::All:
      return true;
    case VerdictFilter::NotAllowed:
      return row.isForbidden;
    case VerdictFilter::Clashing:
      return row.verdict == PairVerdict::Clash || row.verdict == PairVerdict::Contained;
    case VerdictFilter::Touching:
      return row.verdict == PairVerdict::Touching;
    case VerdictFilter::Near:
      return row.verdict == PairVerdict::Near;
    case VerdictFilter::Clear:
      break;
  }
  return row.verdict == PairVerdict::Clear;
}

bool isShownBy(ChangeFilter filter, const ShownFinding& row) {
  const auto is = [&row](FindingChange change) { return row.change == change; };
  switch (filter) {
    case ChangeFilter::All:
      return true;
    case ChangeFilter::New:
      return is(FindingChange::New);
    case ChangeFilter::Changed:
      return is(FindingChange::Worse) || is(FindingChange::Better);
    case ChangeFilter::Gone:
      break;
  }
  return is(FindingChange::Gone);
}

}  // namespace

FindingsFilter::FindingsFilter(QObject* parent) : QSortFilterProxyModel(parent) {
  setSortRole(PairFindingsModel::kSortRole);
  setSortCaseSensitivity(Qt::CaseInsensitive);
}

void FindingsFilter::setText(const QString& text) {
  text_ = text.trimmed();
  invalidateFilter();
}

void FindingsFilter::setVerdict(VerdictFilter verdict) {
  verdict_ = verdict;
  invalidateFilter();
}

void FindingsFilter::setChange(ChangeFilter change) {
  change_ = change;
  invalidateFilter();
}

void FindingsFilter::setState(std::optional<FindingState> state) {
  state_ = state;
  invalidateFilter();
}

bool FindingsFilter::filterAcceptsRow(int row, const QModelIndex&) const {
  const ShownFinding& finding = static_cast<const PairFindingsModel*>(sourceModel())->at(row);
  const auto has = [this](const QString& text) { return text.contains(text_, Qt::CaseInsensitive); };
  const bool isNamed = text_.isEmpty() || has(finding.part) || has(finding.other) || has(finding.reason);
  return isNamed && isShownBy(verdict_, finding) && isShownBy(change_, finding) &&
         (!state_ || finding.state == *state_);
}

}  // namespace nearfit::ui
