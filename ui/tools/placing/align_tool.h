#pragma once

#include <QObject>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/placing/align.h"
#include "core/placing/feature_pick.h"
#include "core/session/session.h"
#include "ui/tools/placing/feature_picker.h"
#include "ui/widgets/view_bar.h"

class QAction;
class QCheckBox;
class QComboBox;
class QLabel;
class QPushButton;

namespace nearfit::ui {

class HandState;
class MoveGuard;
class NumberField;
class PlacingTools;
class SceneWork;
class Selection;
class Viewport;

/// The align tool's bar: prompt, filter, flip, distance, apply and cancel.
class AlignBar : public ViewBar {
  Q_OBJECT

 public:
  explicit AlignBar(QWidget* view);

  /// Shows what to do next.
  /// @param hint  The feature under the pointer; may be empty.
  void showPrompt(const QString& prompt, const QString& hint);
  /// Shows the options of the picked pair; hides them before there is one.
  /// @param isPicked   Both features are picked.
  /// @param canFlip    Flipping makes a difference.
  /// @param canOffset  A distance can be left between them.
  void showPair(bool isPicked, bool canFlip, bool canOffset);
  /// Resets flip and distance and hides the options.
  void reset();

  FeatureFilter filter() const;
  /// False while flipping is not possible.
  bool isFlipped() const;
  /// Distance between the features [m].
  double offset() const;

 signals:
  /// Emitted when the user chose which features can be picked.
  void filterChosen(nearfit::FeatureFilter filter);
  /// Emitted when flip or distance changed.
  void optionsEdited();
  /// Emitted by Apply; not while the distance cannot be read.
  void applied();
  /// Emitted by Cancel.
  void cancelled();

 private:
  void setUpFields();

  QLabel *prompt_, *hint_;
  QComboBox* filter_;
  QCheckBox* flip_;
  QLabel* offsetLabel_;
  NumberField* offset_;
  QPushButton *apply_, *cancel_;
};

/// Aligns a part by two clicks in the view: on a feature of the part, then on the feature of another part
/// that it is to meet. Previews the result; Apply or Return makes it one undo step, Escape discards it. A
/// selected part takes the other selected parts along. Locked parts cannot be moved.
class AlignTool : public QObject {
  Q_OBJECT

 public:
  /// What it needs; all outlive this.
  struct Context {
    Session& session;
    Selection& selection;
    Viewport& view;
    const MoveGuard& guard;
    const HandState& hand;
    const SceneWork& work;
    PlacingTools& placing;
  };
  AlignTool(const Context& context, QObject* parent);
  ~AlignTool() override;

  /// Starts and stops the tool.
  QAction* action() const noexcept { return action_; }

 signals:
  /// Emitted with a note for the status bar.
  void noted(const QString& text);

 private:
  /// Enables the tool if parts can be aligned now; stops it if they cannot.
  void updateAvailability();
  void start();
  void stop();
  void take(const FeaturePick& pick);
  void retake();
  void preview();
  void apply();
  void tell(const QString& hint);
  QString prompt() const;
  QString refusalOf(const Part& part) const;
  bool isMoved(PartId part) const;
  bool isSound() const;

  Session& session_;
  Selection& selection_;
  Viewport& view_;
  const MoveGuard& guard_;
  const HandState& hand_;
  const SceneWork& work_;
  PlacingTools& placing_;
  QAction* action_;
  AlignBar* bar_;
  FeaturePicker picker_;
  FeatureHighlight movingLight_, fixedLight_;
  std::optional<FeaturePick> moving_, fixed_;
  std::map<PartId, RigidTransform> start_;  ///< worldFromPart of the moving parts at the first pick.
  std::uint64_t sceneSerial_ = 0;           ///< Serial of the scene that owns what was picked.
  RigidTransform motion_;
  Subscription changes_;
};

}  // namespace nearfit::ui
