#pragma once

#include <QObject>
#include <optional>
#include <vector>

#include "core/placing/gizmo.h"
#include "core/session.h"
#include "ui/placing/feature_picker.h"
#include "ui/section/plane_sheet.h"
#include "ui/section/section_bar.h"

class QAction;
class QWidget;

namespace nearfit::ui {

class GizmoControl;
class Viewport;

/// Cuts the view open by a plane, laid across an axis, the direction of sight or a face that is clicked: it
/// is moved by slider, number and an arrow in the view, tilted by two rings, turned round, and may leave the
/// moving part whole. A state of the view, none of the scene: nothing to undo. The plane is kept while the
/// program runs; which axis, and whether the moving part is spared, from run to run.
class SectionTool : public QObject {
  Q_OBJECT

 public:
  /// @param session, view  Outlive this.
  /// @param window         Around the view: Escape anywhere in it closes the section. Its parent.
  SectionTool(const Session& session, Viewport& view, QWidget* window);
  ~SectionTool() override;

  /// Switches it on and off.
  QAction* action() const noexcept { return action_; }

  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void connectBar();
  void connectHandle();
  void connectPicker();
  void start();
  void stop();
  /// Across an axis through the middle of the scene; what is nearer to the viewer is cut away.
  void layAcross(SectionAxis axis);
  void layOn(const FeaturePick& pick);
  void lay(std::optional<SectionAxis> axis, const GizmoFrame& frame, int across, double origin);
  void pickFace(bool isWanted);
  /// The drag of a handle has come to this.
  void drag(const RigidTransform& motion);
  /// @param position  As the bar shows it [m].
  void moveTo(double position);
  /// The parts have changed: slider and sheet go by where they are.
  void follow();
  void show();
  glm::dvec3 direction() const { return frame_.axes[across_]; }
  /// As the bar shows it [m].
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
  std::optional<SectionAxis> axis_ = SectionAxis::X;  ///< Nothing once it has been tilted.
  GizmoFrame frame_;                                  ///< The plane goes through its pivot.
  int across_ = 0;                                    ///< Of the frame's axes.
  double origin_ = 0.0;                               ///< That positions count from [m].
  bool isFarSideCut_ = false;                         ///< What is cut away lies against the direction.
  std::optional<GizmoFrame> frameAtStart_;            ///< Of a drag.
  std::optional<SectionAxis> axisAtStart_;
  double originAtStart_ = 0.0;
  Aabb box_;  ///< Around the visible parts.
  bool isLaid_ = false;
  QString asked_;  ///< While a face is asked for.
};

}  // namespace nearfit::ui
