#pragma once

#include <QObject>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/placing/align.h"
#include "core/session/session.h"
#include "ui/tools/placing/feature_picker.h"

class QAction;

namespace nearfit::ui {

class AlignBar;
class HandState;
class MoveGuard;
class PlacingTools;
class SceneWork;
class Selection;
class Viewport;

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
