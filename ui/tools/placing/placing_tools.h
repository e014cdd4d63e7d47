#pragma once

#include <QObject>
#include <optional>
#include <vector>

#include "core/placing/gizmo.h"
#include "core/placing/pivot.h"
#include "core/session/session.h"
#include "ui/tools/placing/part_mover.h"
#include "ui/widgets/error_box.h"

class QMainWindow;
class QMenu;
class QToolBar;

namespace nearfit::ui {

class GizmoControl;
class MoveGuard;
class PlacingActions;
class SceneWork;
class Selection;
class Viewport;

/// The part in hand while the servo runs. ShownPoses knows where the servo has it.
struct HeldPart {
  PartId part{};
  RigidTransform worldFromHand;  ///< Where the hand wants it.
  bool isManual = false;         ///< The hand can be moved by these tools.
};

/// Places the selected parts together by gizmo and direct drag; each drag is one undo step. A part in the
/// manual hand is moved by moving that hand. Locked parts and parts in any other hand get no gizmo.
class PlacingTools : public QObject {
  Q_OBJECT

 public:
  /// @param session, selection, view, guard, work  Outlive this.
  PlacingTools(Session& session, Selection& selection, Viewport& view, const MoveGuard& guard,
               SceneWork& work, QObject* parent = nullptr);

  /// Adds the actions to `menu`, and a toolbar on its own row to `window`. Returns the toolbar. Call once.
  QToolBar* addTo(QMainWindow& window, QMenu& menu);

  /// Sets the part in hand; nullopt: the servo does not run.
  void setHeld(const std::optional<HeldPart>& held);
  /// Hides the gizmo while another tool moves parts.
  void setAside(bool isAside);
  /// Ends a move that is still settling and puts its present poses into the session; for
  /// those who need the scene.
  void commit();
  /// Returns the scene with the part in hand where the servo has it.
  Scene sceneNow() const;
  /// Moves parts together so that the lead gets that pose, as one undo step. Where joints do not allow it they go as
  /// near as these do, with noted(). Solid parts move asynchronously, as near to it as contact allows. If one of the
  /// parts may not be moved, emits noted() and does nothing. Not for a part in hand.
  /// @param verb  Name of the undo step, before the part's name; a string literal.
  void bring(const std::vector<PartId>& parts, PartId lead, const RigidTransform& worldFromLead,
             const char* verb);

 signals:
  /// Emitted when the manual hand is to want the part there.
  void handWanted(const nearfit::RigidTransform& worldFromPart);
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a note for the status bar.
  void noted(const QString& text);

 private:
  /// A move to a known pose, which it must reach exactly.
  struct Brought {
    PartId lead{};
    RigidTransform worldFromLead;
    const char* verb;
    QString note = {};  ///< Told when they are there.
  };

  std::vector<PlacedPart> placedParts() const;
  std::vector<PlacedPart> placed(const std::vector<PartId>& parts) const;
  RigidTransform heldPose() const;
  bool isMovable(const Part& part) const;
  /// True if the selection is exactly the part in the manual hand.
  bool leadsHand() const;
  std::optional<GizmoFrame> frame() const;
  std::optional<glm::dvec3> grab(const QPoint& position) const;

  void showActions();
  void showFrame();
  void setPivot(const std::optional<glm::dvec3>& inWorld);
  void begin(GizmoGrip handle);
  void follow(const RigidTransform& motion);
  void finish();
  void takeBack();
  bool isDragSound() const;
  bool isMoveSound() const;
  void abandon();
  void giveUpParts();
  void putMoved();
  void put(const std::vector<PartId>& parts, const Brought& where);
  void showMoved();
  QString note() const;

  Session& session_;
  Selection& selection_;
  Viewport& view_;
  const MoveGuard& guard_;
  PlacingActions* actions_;
  GizmoControl* control_;
  PartMover mover_;
  std::optional<HeldPart> held_;

  enum class Drag { None, Parts, Hand, Pivot };
  Drag drag_ = Drag::None;
  GizmoGrip handle_ = GizmoGrip::None;
  RigidTransform handAtStart_, heldAtStart_;
  std::optional<glm::dvec3> draggedPivot_;  ///< In the world [m].
  std::optional<Brought> brought_;
  bool isAside_ = false;
  Subscription changes_;
};

}  // namespace nearfit::ui
