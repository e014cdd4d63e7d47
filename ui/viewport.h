#pragma once

#include <QPoint>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include <QVTKOpenGLNativeWidget.h>
#include <vtkBoundingBox.h>
#include <vtkCameraOrientationWidget.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include "core/haptics/servo_tick.h"
#include "core/placing/view_projection.h"
#include "core/scene/scene.h"
#include "ui/camera_views.h"
#include "ui/detail/kept_renderer.h"
#include "ui/minima/minima_choice.h"
#include "ui/scene_renderer.h"

namespace nearfit::ui {

class HandDrag;
class PicturePace;
class Selection;
class SnapshotGlyphs;
class ViewDetail;
class ViewPicture;

/// The 3-D view: the scene's parts, and over them what the newest servo snapshot tells.
/// Draws only after a change. Left drag orbits, so does a middle drag with Ctrl, middle drag pans, wheel or
/// right drag zooms; a click selects, with Ctrl it adds or takes out, with Shift it adds. BoxSelect draws
/// rectangles on it.
class Viewport : public QVTKOpenGLNativeWidget {
  Q_OBJECT

 public:
  /// @param selection  Outlives this.
  Viewport(std::shared_ptr<PartShapeCache> shapes, Selection& selection, QWidget* parent = nullptr);
  ~Viewport() override;

  /// Sets OpenGL's version and buffers for all windows; before the QApplication is made.
  static void setDefaultSurfaceFormat();

  void setScene(const Scene& scene);
  /// Shows the part in hand, where the hand wants it, its minima, contacts and wrench, and what it overlaps;
  /// nothing is drawn when nothing of that has changed.
  void showSnapshot(const ServoSnapshot& snapshot);
  /// Back to the scene alone.
  void clearSnapshot();

  /// As SceneRenderer::setDragged.
  void setDragged(std::map<PartId, RigidTransform> worldFromPart);
  /// Where a part is shown now; nothing when it is not in the scene.
  std::optional<RigidTransform> shownPose(PartId part) const;
  /// How the view shows the world now, in the widget's own pixels.
  ViewProjection projection() const;
  /// The box around all visible parts, whole, in the world; empty when there are none.
  Aabb visibleBounds() const;
  /// Cuts the parts open; nothing: they are whole.
  void setCut(const std::optional<ViewCut>& cut);
  /// Parts that are cut and cannot be closed, as of the last picture.
  const std::vector<PartId>& openlyCut() const noexcept { return parts_.openlyCut(); }
  /// What is seen at a place of the widget.
  std::optional<PickedPoint> pointAt(const QPoint& position);
  /// Parts of which something is seen in a rectangle of the widget, in the scene's order.
  std::vector<PartId> partsIn(const QRect& place) const;
  /// Does what a click there does: selects.
  void pickAt(const QPoint& position, Qt::KeyboardModifiers modifiers);

  /// Clicks are a tool's from now on: others that took them are told to leave.
  void takeClicks(QObject* tool) { emit clicksTaken(tool); }

  /// What is drawn over the scene, for tools that add to it; requestRender() shows what they changed.
  vtkRenderer& overlay() noexcept { return *overlay_.Get(); }
  vtkCamera* camera() { return renderer_->GetActiveCamera(); }
  void requestRender();

  /// The mouse as the manual hand.
  HandDrag& handDrag() noexcept { return *handDrag_; }

  void fit();
  /// Parts of the scene with what is around them.
  void fitParts(const std::vector<PartId>& parts);
  void setView(StandardView view);
  void setSeeThrough(bool isSeeThrough);
  void setEdgesVisible(bool isVisible);
  void setMinimaVisible(bool isVisible);
  void setMinimaChoice(const MinimaChoice& choice);
  void setContactsVisible(bool isVisible);
  void setHandVisible(bool isVisible);
  void setWrenchVisible(bool isVisible);

  /// How much of the parts the last picture shows, and how much pictures may while something moves.
  ViewDetail& detail() noexcept { return *detail_; }
  SceneRenderer& parts() noexcept { return parts_; }
  /// Draws what was left out to be quick, however long that takes: for pictures that are taken away.
  void completePicture();
  /// Takes pictures of the view away.
  ViewPicture& pictures() noexcept { return *pictures_; }

  /// Pictures drawn since the start: tests check with it that an idle view stays idle.
  int pictureCount() const noexcept { return pictureCount_; }

 signals:
  /// A picture has been drawn, maybe from elsewhere.
  void drawn();
  /// Parts came, left or are shown elsewhere: what stands by them follows before the next picture.
  void posesChanged();
  void clicksTaken(QObject* tool);
  /// An arrow or page key: a step of the current part along one axis of the world, each component -1, 0
  /// or 1.
  void nudged(int x, int y, int z);
  /// The same with Shift: a turn about that axis.
  void turned(int x, int y, int z);

 protected:
  void mousePressEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;
  void paintGL() override;

 private:
  void setUpRenderers();
  void setUpInteraction();
  void prepareRender();
  void adjustClipping();
  /// Of all that the next picture shows, in the world [m].
  vtkBoundingBox drawnBounds();
  void countPicture();
  void showMovingPart();
  void showSelection();

  vtkNew<vtkGenericOpenGLRenderWindow> window_;
  vtkNew<KeptRenderer> renderer_;
  vtkNew<BlendingRenderer> overlay_;
  vtkNew<vtkCameraOrientationWidget> marker_;
  std::shared_ptr<PartShapeCache> shapes_;
  Selection& selection_;
  SceneRenderer parts_;
  std::unique_ptr<ViewDetail> detail_;
  std::unique_ptr<SnapshotGlyphs> glyphs_;
  std::unique_ptr<PicturePace> pace_;
  std::unique_ptr<ViewPicture> pictures_;
  HandDrag* handDrag_;
  std::unique_ptr<ServoSnapshot> shown_;
  bool hasNewNumbers_ = false;  ///< What shown_ says has not been drawn yet.
  Scene scene_;
  std::set<PartId> known_;  ///< Parts that have been shown, also those that have left.
  QPoint pressedAt_;
  int pictureCount_ = 0;
};

}  // namespace nearfit::ui
