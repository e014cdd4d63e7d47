#pragma once

#include <QPoint>
#include <memory>
#include <optional>
#include <set>

#include <QVTKOpenGLNativeWidget.h>
#include <vtkBoundingBox.h>
#include <vtkCameraOrientationWidget.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include "core/placing/view_projection.h"
#include "core/scene/scene.h"
#include "core/servo/servo_tick.h"
#include "ui/view3d/camera/camera_views.h"
#include "ui/view3d/drawing/caching_renderer.h"
#include "ui/view3d/glyphs/minima_choice.h"
#include "ui/view3d/parts/scene_renderer.h"

namespace nearfit::ui {

class HandDrag;
class PicturePace;
class ScaleBar;
class Selection;
class ShownPoses;
class SnapshotGlyphs;
class ViewDetail;
class ViewPicture;

/// The 3-D view: the scene's parts, and over them the newest servo snapshot. Draws only after a change.
///
/// Left drag or Ctrl+middle drag orbits, middle drag pans, wheel or right drag zooms. A click selects; with
/// Ctrl it adds or removes, with Shift it adds. BoxSelect draws rectangles on the view.
class Viewport : public QVTKOpenGLNativeWidget {
  Q_OBJECT

 public:
  /// @param selection, poses  Outlive this.
  Viewport(std::shared_ptr<PartShapeCache> shapes, Selection& selection, ShownPoses& poses,
           QWidget* parent = nullptr);
  ~Viewport() override;

  /// Sets the OpenGL surface format of all windows. Call before constructing the QApplication.
  static void setDefaultSurfaceFormat();

  /// Shows a scene; turns to the isometric view if none of its parts has been shown before.
  void setScene(const Scene& scene);
  /// Draws the shapes of parts that have been made since boxes stood in for them.
  void takeNewShapes();
  /// Shows the hand's ghost, minima, contacts, wrench and overlapping parts; ShownPoses moves the part in hand.
  /// Draws nothing if none of these changed.
  void showSnapshot(const ServoSnapshot& snapshot);
  /// Shows a ghost that nobody feels, in the same way but without the legend: its numbers would be of nothing.
  void showGhost(const ServoSnapshot& ghost);
  /// Draws the snapshot paler from now on: it is past, and nothing is felt any more. No-op without one, and for a ghost
  /// that nobody felt.
  void keepSnapshot();
  /// Removes the snapshot and shows the scene alone.
  void clearSnapshot();

  /// Where the view shows its parts, and where tools put what they move.
  ShownPoses& poses() const noexcept { return poses_; }
  /// Returns how the view projects the world now, in the widget's device-independent pixels.
  ViewProjection projection() const;
  /// Returns the bounds of all visible parts, uncut, in the world [m]; empty if there are none.
  Aabb visibleBounds() const;
  /// Cuts the parts open; nullopt: they are whole.
  void setCut(const std::optional<ViewCut>& cut);
  /// Parts that are cut but cannot be closed, as of the last picture.
  const std::vector<PartId>& openlyCut() const noexcept { return parts_.openlyCut(); }
  /// Returns what is seen at a pixel of the widget; nullopt over the background.
  std::optional<PickedPoint> pointAt(const QPoint& position, SeenThrough seenThrough = SeenThrough::AsOthers,
                                     const IsNearAt& isNearAt = {});
  /// Returns the parts seen somewhere in a rectangle of the widget, in the scene's order.
  std::vector<PartId> partsIn(const QRect& place) const;
  /// Selects as a click at that pixel does.
  void pickAt(const QPoint& position, Qt::KeyboardModifiers modifiers);

  /// Gives clicks to a tool: other tools that take clicks stop, at clicksTaken().
  void takeClicks(QObject* tool) { emit clicksTaken(tool); }

  /// Renderer drawn over the scene, for tools to add actors; call requestRender() after a change.
  vtkRenderer& overlay() noexcept { return *overlay_.Get(); }
  vtkCamera* camera() { return renderer_->GetActiveCamera(); }
  /// Requests a picture; several requests until it is due are answered by one.
  void requestRender();

  /// The mouse as the manual hand.
  HandDrag& handDrag() noexcept { return *handDrag_; }

  /// Shows parts through others without selecting them; empty: none.
  void highlight(const std::vector<PartId>& parts);

  /// Draws these parts in the colours of their clearances; see SceneRenderer::setColours().
  void setColours(const SceneRenderer::Colours& colours, bool isStale);

  /// Fits all visible parts into the view.
  void fit();
  /// Fits these parts into the view, with some room around them.
  void fitParts(const std::vector<PartId>& parts);
  /// Fits a place into the view, seen from where the camera looks now.
  /// @param box  World [m]; nothing happens if it is empty.
  void fitBox(const Aabb& box);
  /// Turns to a standard view and fits all visible parts.
  void setView(StandardView view);
  /// Changes to orthographic projection or back to perspective; what is in the middle keeps its size.
  void setOrthographic(bool isOrthographic);
  void setSeeThrough(bool isSeeThrough);
  void setEdgesVisible(bool isVisible);
  void setMinimaVisible(bool isVisible);
  void setMinimaChoice(const MinimaChoice& choice);
  void setContactsVisible(bool isVisible);
  void setHandVisible(bool isVisible);
  void setWrenchVisible(bool isVisible);
  /// Shows a bar of a round length, true at the depth of the point that the camera orbits; hidden at first.
  void setScaleBarVisible(bool isVisible);
  void setLegendVisible(bool isVisible);

  /// How much of the parts the last picture shows, and the limits while something moves.
  ViewDetail& detail() noexcept { return *detail_; }
  SceneRenderer& parts() noexcept { return parts_; }
  /// Draws a picture in full detail, however long that takes; for screenshots.
  void completePicture();
  /// Exports pictures of the view.
  ViewPicture& pictures() noexcept { return *pictures_; }

  /// Number of pictures drawn so far; tests use it to check that an idle view stays idle.
  int pictureCount() const noexcept { return pictureCount_; }

 signals:
  /// Emitted after each picture, requested here or elsewhere.
  void drawn();
  /// Emitted with each snapshot shown once the view looks like it; a snapshot that is followed by another before
  /// the next picture is left out. At once if the view already looks like it, or is hidden.
  void snapshotDrawn(const nearfit::ServoSnapshot& snapshot);
  /// Emitted once the view has placed its parts after some came, left or are shown elsewhere. For what is
  /// drawn with them, which updates before the next picture; all else follows ShownPoses::changed().
  void posesChanged();
  /// Emitted when `tool` takes the clicks; see takeClicks().
  void clicksTaken(QObject* tool);
  /// Emitted for an arrow or page key: a step of the current part along one world axis; each
  /// component is -1, 0 or 1.
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
  /// Bounds of everything that the next picture shows, in the world [m].
  vtkBoundingBox drawnBounds();
  void countPicture();
  void takeSnapshot(const ServoSnapshot& snapshot, bool isFelt);
  /// Draws what takeSnapshot() got, from the next picture on.
  void draw(const ServoSnapshot& snapshot);
  void showScale();
  void showMovingPart();
  void showSelection();
  void placeParts(const std::vector<PartId>& parts);

  vtkNew<vtkGenericOpenGLRenderWindow> window_;
  vtkNew<CachingRenderer> renderer_;
  vtkNew<BlendingRenderer> overlay_;
  vtkNew<vtkCameraOrientationWidget> marker_;
  std::shared_ptr<PartShapeCache> shapes_;
  Selection& selection_;
  ShownPoses& poses_;
  SceneRenderer parts_;
  std::unique_ptr<ViewDetail> detail_;
  std::unique_ptr<SnapshotGlyphs> glyphs_;
  std::unique_ptr<PicturePace> pace_;
  std::unique_ptr<ViewPicture> pictures_;
  HandDrag* handDrag_;
  ScaleBar* scaleBar_;
  std::unique_ptr<ServoSnapshot> shown_;
  bool hasNewNumbers_ = false;  ///< shown_ has not been drawn yet.
  double movingSize_ = 0.0;     ///< Diagonal of what the hand moves [m].
  bool isPast_ = false;         ///< shown_ is no longer felt.
  bool isFelt_ = true;          ///< False: shown_ is a ghost that nobody feels or felt.
  Scene scene_;
  std::set<PartId> known_;  ///< Parts shown so far, including ones that have left.
  QPoint pressedAt_;
  int pictureCount_ = 0;
};

}  // namespace nearfit::ui
