#pragma once

#include <QPoint>
#include <memory>
#include <optional>

#include <QVTKOpenGLNativeWidget.h>
#include <vtkCameraOrientationWidget.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include "core/haptics/servo_tick.h"
#include "core/scene/scene.h"
#include "ui/camera_views.h"
#include "ui/contact_glyphs.h"
#include "ui/hand_ghost.h"
#include "ui/lmd_overlay.h"
#include "ui/scene_renderer.h"
#include "ui/wrench_arrows.h"

namespace nearfit::ui {

class ColourLegend;

/// The 3-D view: the scene's parts, and over them what the newest servo snapshot tells.
/// Draws only after a change. Left drag orbits, middle drag pans, wheel or right drag zooms, a click picks.
class Viewport : public QVTKOpenGLNativeWidget {
  Q_OBJECT

 public:
  explicit Viewport(std::shared_ptr<PartShapeCache> shapes, QWidget* parent = nullptr);
  ~Viewport() override;

  /// Sets OpenGL's version and buffers for all windows; before the QApplication is made.
  static void setDefaultSurfaceFormat();

  void setScene(const Scene& scene);
  void setSelected(std::optional<PartId> part);
  /// Shows the part in hand, where the hand wants it, its minima, contacts and wrench, and what it overlaps;
  /// nothing is drawn when nothing of that has changed.
  void showSnapshot(const ServoSnapshot& snapshot);
  /// Back to the scene alone.
  void clearSnapshot();

  void fit();
  /// A part of the scene with what is around it.
  void fitPart(PartId part);
  void setView(StandardView view);
  void setSeeThrough(bool isSeeThrough);
  void setEdgesVisible(bool isVisible);
  void setMinimaVisible(bool isVisible);
  void setContactsVisible(bool isVisible);
  void setHandVisible(bool isVisible);
  void setWrenchVisible(bool isVisible);

  /// Pictures drawn since the start: tests check with it that an idle view stays idle.
  int pictureCount() const noexcept { return pictureCount_; }

 signals:
  /// A click on a part; empty on the background.
  void partPicked(std::optional<nearfit::PartId> part);
  /// An arrow or page key: a step of the selected part along one axis of the world, each component -1, 0
  /// or 1.
  void nudged(int x, int y, int z);

 protected:
  void mousePressEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  void setUpRenderers();
  void setUpInteraction();
  void prepareRender();
  void adjustClipping();
  void countPicture();
  void requestRender();
  void showMovingPart();
  void placeLegend();
  void pickAt(const QPoint& position);

  vtkNew<vtkGenericOpenGLRenderWindow> window_;
  vtkNew<vtkRenderer> renderer_, overlay_;
  vtkNew<vtkCameraOrientationWidget> marker_;
  std::shared_ptr<PartShapeCache> shapes_;
  SceneRenderer parts_;
  HandGhost hand_;
  LmdOverlay minima_;
  ContactGlyphs contacts_;
  WrenchArrows arrows_;
  ColourLegend* legend_;
  std::unique_ptr<ServoSnapshot> shown_;
  Scene scene_;
  QPoint pressedAt_;
  bool hasRequest_ = false;
  int pictureCount_ = 0;
};

}  // namespace nearfit::ui
