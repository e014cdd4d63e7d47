#pragma once

#include <QAbstractTableModel>
#include <QString>
#include <optional>
#include <vector>

#include "core/verdict/finding_states.h"

namespace nearfit::ui {

/// A finding of a scene check as people read it: of this check, or of the last one.
struct ShownFinding {
  PartPair pair;
  QString part, other;  ///< Names.
  PairVerdict verdict = PairVerdict::Clear;
  bool isForbidden = false;        ///< A clash, or a part inside another one, that no rule allows.
  QString rule;                    ///< The rule that allows it, in words; empty if none does.
  std::optional<double> distance;  ///< [m]; no value if it is gone.
  std::optional<double> depth;     ///< [m]
  bool isDepthExact = false;       ///< Else the depth is at most this.
  std::optional<double> volume;    ///< [m^3]
  QString volumeProblem;           ///< Why the volume of a clash is not known.
  /// No value if nothing is compared: it is what the scene keeps of its last check.
  std::optional<FindingChange> change;
  std::optional<PairRecord>
      before;  ///< As the last check found it; no value if it did not, or nothing is compared.
  FindingState state = FindingState::New;
  QString reason;
  bool isKept = false;               ///< The scene keeps it, so that its state can be changed.
  const PairFinding* now = nullptr;  ///< As found by this check; null if it is gone, or of the last check.
};

/// Rows of a check: findings that are there, and those that are gone. Without pairs that were not checked this time.
/// @param scene     As it was checked; has all parts.
/// @param compared  Of this check; outlives the rows.
std::vector<ShownFinding> shownFindings(const Scene& scene, const SceneCheck& check,
                                        const std::vector<ComparedFinding>& compared);

/// Rows of what a scene keeps of its last check.
std::vector<ShownFinding> shownRecords(const Scene& scene);

/// Words for people.
QString nameOf(PairVerdict verdict);
QString nameOf(FindingState state);
QString nameOf(FindingChange change);
/// The state in a word; "changed" for a finding that was accepted and became another since (wasAccepted()).
QString stateText(const ShownFinding& finding);
/// The change with what was found before: "worse, was 0.40 mm", "better, was clash".
QString changeText(const ShownFinding& finding);
/// A rule in words, its length in the unit that the user chose: "Press fit: Bush* and Housing, up to 20 µm".
QString ruleText(const PairRule& rule);
/// The depth with what is known of it: "1.20 mm", "at most 1.20 mm"; empty if there is none.
QString depthText(const ShownFinding& finding);
/// Formats a volume in the unit of length that the user chose: "12.3 mm³", "0.5 in³".
QString formatVolume(double cubicMetres);

/// Findings of a scene check as a table: the two parts, verdict, measures, change since the last check, and
/// what the user says about it.
class PairFindingsModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { First, Second, Verdict, Distance, Depth, Volume, Change, State, Reason, ColumnCount };
  /// Role for the value that a column is sorted by.
  static constexpr int kSortRole = Qt::UserRole;

  using QAbstractTableModel::QAbstractTableModel;

  /// Replaces the rows.
  void show(std::vector<ShownFinding> rows);
  /// Takes names, states and reasons from a scene.
  void follow(const Scene& scene);
  /// Greys all rows out: they are of a scene that has changed since.
  void setStale(bool isStale);
  /// Tells that lengths are shown in another unit.
  void refresh();
  /// Returns the finding in a row; `row` must be valid.
  const ShownFinding& at(int row) const { return rows_[static_cast<std::size_t>(row)]; }

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  static QString textOf(const ShownFinding& row, int column);
  static QString toolTipOf(const ShownFinding& row, int column);
  static QVariant sortKeyOf(const ShownFinding& row, int column);
  QVariant colourOf(const ShownFinding& row, int column) const;

  std::vector<ShownFinding> rows_;
  bool isStale_ = false;
};

}  // namespace nearfit::ui
