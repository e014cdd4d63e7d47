#pragma once

#include <QObject>
#include <optional>
#include <vector>

#include "core/placing/gizmo.h"
#include "core/session/session.h"
#include "ui/tools/placing/feature_picker.h"
#include "ui/tools/section/section_bar.h"
#include "ui/view3d/parts/scene_cut.h"

class QAction;
class QWidget;

namespace nearfit::ui {

class GizmoControl;
class Viewport;

/// Cuts the view open by a plane across a world axis, the direction of view or a clicked face. Slider, number
/// and an arrow in the view move the plane, two rings tilt it; it can be flipped, and the moving part can
/// stay whole. Changes the view only, not the scene: there is nothing to undo. Keeps the plane while the
/// program runs, and the axis and the choice for the moving part between runs.
class SectionTool : public QObject {
  Q_OBJECT

 public:
  /// @param session, view  Outlive this.
  /// @param window         The parent, around the view; Escape anywhere in it closes the section.
  SectionTool(const Session& session, Viewport& view, QWidget* window);
  ~SectionTool() override;

  /// Starts and stops the tool.
  QAction* action() const noexcept { return action_; }

  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void connectBar();
  void connectHandle();
  void connectPicker();
  void start();
  void stop();
  /// Lays the plane across an axis through the middle of the scene; cuts away the side nearer to the viewer.
  void layAcross(SectionAxis axis);
  /// Lays the plane through a picked face; cuts away the side that the face looks to.
  void layOn(const FeaturePick& pick);
  void lay(std::optional<SectionAxis> axis, const GizmoFrame& frame, int across, double origin);
  void pickFace(bool isWanted);
  /// Moves or tilts the plane by a drag of the handle.
  /// @param motion  World motion since the drag began.
  void drag(const RigidTransform& motion);
  /// @param position  As shown by the bar [m].
  void moveTo(double position);
  /// Fits slider and sheet to parts that have moved.
  void follow();
  void show();
  glm::dvec3 direction() const { return frame_.axes[across_]; }
  /// The plane's position as shown by the bar [m].
  double position() const;
  CutPlane plane() const;
  QString positionText() const;
  void tell();

  const Session& session_;
  Viewport& view_;
  QAction* action_;
  SectionBar* bar_;
  GizmoControl* handle_;
  FeaturePicker picker_;
  PlaneSheet sheet_;
  std::optional<SectionAxis> axis_ = SectionAxis::X;  ///< Nullopt once tilted.
  GizmoFrame frame_;                                  ///< The plane goes through its pivot.
  int across_ = 0;                                    ///< Axis of frame_ perpendicular to the plane.
  double origin_ = 0.0;                               ///< Offset from which positions count [m].
  bool isFarSideCut_ = false;                         ///< Cuts away the side opposite to direction().
  std::optional<GizmoFrame> frameAtStart_;            ///< Before the present drag; so are the two below.
  std::optional<SectionAxis> axisAtStart_;
  double originAtStart_ = 0.0;
  Aabb box_;  ///< Bounds of the visible parts.
  bool isLaid_ = false;
  QString asked_;  ///< Prompt while a face is asked for; else empty.
};

}  // namespace nearfit::ui
