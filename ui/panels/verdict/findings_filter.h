#pragma once

#include <QSortFilterProxyModel>
#include <QString>
#include <optional>

#include "core/scene/pair_record.h"

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

/// Sorts a PairFindingsModel, and leaves out rows by text, verdict and state.
class FindingsFilter : public QSortFilterProxyModel {
  Q_OBJECT

 public:
  explicit FindingsFilter(QObject* parent = nullptr);

  /// Shows rows with this in a part's name or the reason, in any case; empty: all.
  void setText(const QString& text);
  void setVerdict(VerdictFilter verdict);
  /// @param state  std::nullopt: all.
  void setState(std::optional<FindingState> state);

 protected:
  bool filterAcceptsRow(int row, const QModelIndex& parent) const override;

 private:
  QString text_;
  VerdictFilter verdict_ = VerdictFilter::All;
  std::optional<FindingState> state_;
};

}  // namespace nearfit::ui
