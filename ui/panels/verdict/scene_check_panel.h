#pragma once

#include <QWidget>
#include <memory>
#include <optional>
#include <vector>

#include "core/session/session.h"
#include "ui/model/pair_findings_model.h"
#include "ui/panels/verdict/scene_check_run.h"
#include "ui/view3d/pair_marks.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

class QAction;
class QComboBox;
class QLabel;
class QLineEdit;
class QProgressBar;
class QPushButton;
class QTableView;

namespace nearfit::ui {

class FindingsFilter;
class NumberField;
class Selection;
class Viewport;

/// Checks all pairs of visible parts when asked to, and lists what was found. The view highlights the pairs
/// of the chosen rows and marks the present one: where two parts meet and how to free them, or where they are
/// nearest, until something else is selected or Escape is pressed. It leaves the selection alone. What the user
/// says about findings, and the rules, are steps to undo. While it is hidden the view shows nothing of it.
class SceneCheckPanel : public QWidget {
  Q_OBJECT

 public:
  /// Objects that it checks, and those that show the result; all outlive this.
  struct Context {
    Session& session;
    const Selection& selection;
    Viewport& view;
  };
  /// @param window  Sees the keys that nothing in it has handled; outlives this.
  SceneCheckPanel(const Context& context, QWidget* window);

  /// With some rows of the table, which may be lower.
  QSize sizeHint() const override;

  /// Asks for this panel.
  QAction* action() const noexcept { return action_; }
  /// Gives the focus to the button that begins a check, or ends it.
  void begin();

 public slots:
  /// Shows lengths in the unit that has been chosen.
  void refresh();

 signals:
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  QPushButton* button(const char* name, const QString& text, const QString& help);
  void setUpFields();
  void setUpTable();
  void setUpButtons();
  void setUpMenu();
  void setUpLayout();
  void connectRun();
  void check();
  /// Shows the last result, or else what the scene keeps.
  void showResult();
  void followSession();
  /// Shows what can be done, and what the user should know.
  void showState();
  void showWork();
  QString summaryText() const;
  QString noteText() const;
  /// Rows of the model that are chosen, in the order of the table.
  std::vector<int> chosenRows() const;
  std::vector<PartPair> chosenPairs() const;
  /// Parts of the chosen pairs; one that is in several comes several times.
  std::vector<PartId> chosenParts() const;
  /// The row that the view marks; std::nullopt if none is chosen or the panel is hidden.
  std::optional<int> markedRow() const;
  void choose();
  void framePlace();
  /// Highlights and marks the chosen pairs in the view.
  void showPairs();
  /// Chooses the rows of these pairs, without moving the camera.
  void chooseRowsOf(const std::vector<PartPair>& pairs);
  void setState(FindingState state, const QString& reason = {});
  void accept();
  void askRules(const std::optional<PairRule>& added = std::nullopt);
  void addRuleForPair();
  void exportTable();

  Session& session_;
  Viewport& view_;
  SceneCheckRun run_;
  BackgroundTask writing_;
  PairMarks marks_;
  std::shared_ptr<const CheckedScene> shown_;  ///< Whose findings the rows are; null: what the scene keeps.
  std::vector<PairRecord> shownRecords_;       ///< Records that the rows show while shown_ is null.
  bool isPairShown_ = false;                   ///< Parts are highlighted or marked.
  bool isRestoring_ = false;                   ///< Rows are being chosen again.
  PairFindingsModel* model_;
  FindingsFilter* sorted_;
  QTableView* table_;
  QAction* action_;
  NumberField* threshold_;
  QLineEdit* text_;
  QComboBox *verdicts_, *changed_, *states_;
  QProgressBar* progress_;
  QLabel *summary_, *note_;
  QPushButton *check_, *cancel_, *rules_, *accept_, *fixed_, *reopen_, *ruleForPair_, *export_;
  Subscription changes_;
};

}  // namespace nearfit::ui
