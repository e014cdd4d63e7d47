#pragma once

#include <QObject>
#include <optional>
#include <vector>

#include "core/placing/gizmo.h"
#include "core/placing/pivot.h"
#include "core/session.h"
#include "ui/dialogs/error_box.h"
#include "ui/placing/part_mover.h"

class QMainWindow;
class QMenu;

namespace nearfit::ui {

class GizmoControl;
class MoveGuard;
class PlacingActions;
class Selection;
class Viewport;

/// The part in hand while the servo runs.
struct HeldPart {
  PartId part{};
  RigidTransform worldFromPart;  ///< Where the servo has it.
  RigidTransform worldFromHand;  ///< Where the hand would have it.
  bool isManual = false;         ///< The hand can be led from here.
};

/// Placing by gizmo and by direct drag: the selected parts together, each drag one step of undo. A part that
/// the manual hand holds is led by that hand; one that another hand holds, and locked ones, have no gizmo.
class PlacingTools : public QObject {
  Q_OBJECT

 public:
  /// @param session, selection, view, guard  Outlive this.
  PlacingTools(Session& session, Selection& selection, Viewport& view, const MoveGuard& guard,
               QObject* parent = nullptr);

  /// Its actions, and a toolbar in a row of its own.
  void addTo(QMainWindow& window, QMenu& menu);

  /// Nothing: the servo does not run.
  void setHeld(const std::optional<HeldPart>& held);
  /// Another tool moves parts: there is no gizmo meanwhile.
  void setAside(bool isAside);
  /// Puts what is on its way where it is now; for whoever needs the scene.
  void commit();
  /// Moves parts together so that the lead comes to stand there, or as near as it can where parts are solid;
  /// one step of undo; says so when one of them may not be moved. Not for a part in hand.
  /// @param verb  What undo calls the step, before the part's name.
  void bring(const std::vector<PartId>& parts, PartId lead, const RigidTransform& worldFromLead,
             const char* verb);
  /// The selected ones, by the current one.
  void bring(const RigidTransform& worldFromCurrent);
  /// Where a part is shown while it is dragged; nothing for all others.
  std::optional<RigidTransform> draggedPose(PartId part) const;

 signals:
  /// Parts are dragged, or have been put back.
  void draggedPosesChanged();
  /// The manual hand is to go there.
  void handWanted(const nearfit::RigidTransform& worldFromPart);
  /// What may be touched has no hierarchies yet: they had better be there before a drag.
  void hierarchiesWanted();
  void failed(const nearfit::ui::Failure& failure);
  void noted(const QString& text);

 private:
  /// A move to a pose that is known, to the last bit.
  struct Brought {
    PartId lead{};
    RigidTransform worldFromLead;
    const char* verb;
  };

  std::vector<PlacedPart> placedParts() const;
  std::vector<PlacedPart> placed(const std::vector<PartId>& parts) const;
  bool isMovable(const Part& part) const;
  RigidTransform shownPose(const Part& part) const;
  /// The selected parts are the one that the manual hand holds.
  bool leadsHand() const;
  std::optional<GizmoFrame> frame() const;
  std::optional<glm::dvec3> grab(const QPoint& position) const;

  Scene sceneNow() const;
  void showActions();
  void showFrame();
  void setPivot(const std::optional<glm::dvec3>& inWorld);
  void begin(GizmoHandle handle);
  void follow(const RigidTransform& motion);
  void finish();
  void takeBack();
  bool isDragSound() const;
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
  GizmoHandle handle_ = GizmoHandle::None;
  RigidTransform handAtStart_, heldAtStart_;
  std::optional<glm::dvec3> draggedPivot_;  ///< In the world [m].
  std::optional<Brought> brought_;
  bool isAside_ = false;
  bool isPutting_ = false;  ///< The session changes by this.
};

}  // namespace nearfit::ui
