#pragma once

#include <QObject>
#include <map>
#include <optional>
#include <vector>

#include "core/placing/align.h"
#include "core/session.h"
#include "ui/placing/feature_picker.h"

class QAction;

namespace nearfit::ui {

class AlignBar;
class MoveGuard;
class Selection;
class Viewport;

/// Aligns a part by two clicks in the view: on a feature of it, then on one of another part that it is to
/// meet. Shows where the part would be; Apply or Return puts it there as one step of undo, Escape leaves
/// everything as it was. A selected part takes the other selected ones with it. Locked parts refuse to move.
class AlignTool : public QObject {
  Q_OBJECT

 public:
  /// @param session, selection, view, guard  Outlive this.
  AlignTool(Session& session, Selection& selection, Viewport& view, const MoveGuard& guard, QObject* parent);
  ~AlignTool() override;

  /// Switches it on and off.
  QAction* action() const noexcept { return action_; }
  /// Whether it can be used now; it stops when it no longer can.
  /// @param isBusy  Something is being loaded or prepared: it cannot be begun, but what was begun goes on.
  void setAvailable(bool isAvailable, bool isBusy);

 signals:
  /// These parts are to move together so that the lead comes to stand there.
  void moveWanted(const std::vector<nearfit::PartId>& parts, nearfit::PartId lead,
                  const nearfit::RigidTransform& worldFromLead);
  void noted(const QString& text);
  /// It asks for features and shows where parts would go, or no longer.
  void activeChanged(bool isActive);

 private:
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
  QAction* action_;
  AlignBar* bar_;
  FeaturePicker picker_;
  FeatureHighlight movingLight_, fixedLight_;
  std::optional<FeaturePick> moving_, fixed_;
  std::map<PartId, RigidTransform> start_;  ///< worldFromPart of those that move, when the first was picked.
  RigidTransform motion_;
};

}  // namespace nearfit::ui
