#pragma once

#include <QSortFilterProxyModel>
#include <QString>
#include <optional>

#include "core/verdict/finding_states.h"

namespace nearfit::ui {

/// Verdicts that a table of findings shows.
enum class VerdictFilter {
  All,
  NotAllowed,  ///< Clashes and contained parts that no rule allows.
  Clashing,    ///< Clash or contained.
  Touching,
  Near,
  Clear,  ///< Findings of the last check that are gone.
};

/// Changes since the last check that a table of findings shows.
enum class ChangeFilter {
  All,
  New,
  Changed,  ///< Worse or better.
  Gone,
};

/// Sorts a PairFindingsModel, and leaves out rows by text, verdict, change and state.
class FindingsFilter : public QSortFilterProxyModel {
  Q_OBJECT

 public:
  explicit FindingsFilter(QObject* parent = nullptr);

  /// Shows rows with this in a part's name or the reason, in any case; empty: all.
  void setText(const QString& text);
  void setVerdict(VerdictFilter verdict);
  void setChange(ChangeFilter change);
  /// @param state  std::nullopt: all.
  void setState(std::optional<FindingState> state);

 protected:
  bool filterAcceptsRow(int row, const QModelIndex& parent) const override;

 private:
  QString text_;
  VerdictFilter verdict_ = VerdictFilter::All;
  ChangeFilter change_ = ChangeFilter::All;
  std::optional<FindingState> state_;
};

}  // namespace nearfit::ui
