#pragma once

#include <QList>
#include <QObject>
#include <cstdint>
#include <map>
#include <optional>

#include "core/placing/keep.h"
#include "core/session/session.h"
#include "ui/tools/placing/align_rule.h"
#include "ui/tools/placing/feature_picker.h"
#include "ui/widgets/error_box.h"

class QAction;

namespace nearfit::ui {

class AlignBar;
class HandState;
class MoveGuard;
class PlacingTools;
class SceneWork;
class Selection;
class Viewport;

/// Brings a part onto another one by two clicks in the view: on a feature of the part, then on the feature of another
/// part that it is to meet. Previews the result; Apply or Return makes it one undo step, Escape discards it. Locked
/// parts cannot be moved.
///
/// The rule says what can be picked and where the part goes: it is aligned, inserted, or kept there by a joint. A
/// selected part takes the other selected parts along, but not to a joint. While the servo holds a part, joints can
/// still be made, also of that part, which the servo then leads onto them.
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

  /// Start and stop the tool by each of alignRules(), in their order.
  const QList<QAction*>& actions() const noexcept { return actions_; }

 signals:
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a note for the status bar.
  void noted(const QString& text);

 private:
  void makeActions();
  void connectTool();
  /// Enables the rules that can be used now; stops the tool if its own cannot.
  void updateAvailability();
  bool canUse(const AlignRule& rule) const;
  void start(const AlignRule& rule);
  void stop();
  void take(const FeaturePick& pick);
  void takeMoving(const FeaturePick& pick, const Part& part);
  void takeFixed(const FeaturePick& pick, const Part& part);
  void showOptions();
  void preview();
  void previewMove(const RigidTransform& wanted);
  void previewJoint(const RigidTransform& wanted);
  void showLights();
  void apply();
  void applyJoint();
  void tell(const QString& hint);
  QString prompt() const;
  QString idleHint() const;
  QString refusalOf(const Part& part) const;
  /// Why a part cannot be the first; empty if it can.
  QString refusalToMove(const Part& part) const;
  bool isMoved(PartId part) const;
  bool isSound() const;
  /// The joint that Apply makes; nullopt: it only moves.
  std::optional<JointKind> jointKind() const;

  /// A feature that was picked, as the rule sees it.
  struct Picked {
    PartId part{};
    AlignFeature inPart;
    bool isUnseated =
        false;  ///< A round edge without a flat face in its plane, of which only the axis counts.
  };
  Picked pickedBy(const FeaturePick& pick, const Part& part) const;
  /// The picked feature where its part is now.
  FeatureAt placedNow(const Picked& picked) const;

  Session& session_;
  Selection& selection_;
  Viewport& view_;
  const MoveGuard& guard_;
  const HandState& hand_;
  const SceneWork& work_;
  PlacingTools& placing_;
  QList<QAction*> actions_;
  AlignBar* bar_;
  FeaturePicker picker_;
  FeatureHighlight movingLight_, fixedLight_;
  const AlignRule* rule_;  ///< The one that was started last.
  std::optional<Picked> moving_, fixed_;
  std::map<PartId, RigidTransform> start_;  ///< worldFromPart of the moving parts at the first pick.
  std::uint64_t sceneSerial_ = 0;           ///< Serial of the scene that owns what was picked.
  RigidTransform pose_;                     ///< Of the part with the first feature; worldFromPart.
  std::optional<Joint> joint_;              ///< The joint that Apply makes there.
  bool isContradicting_ = false;            ///< It contradicts other joints of the part.
  Subscription changes_;
};

}  // namespace nearfit::ui
