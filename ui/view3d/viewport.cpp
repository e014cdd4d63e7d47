#include "ui/view3d/viewport.h"

#include <QApplication>
#include <QEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QSurfaceFormat>
#include <algorithm>
#include <utility>

#include <QVTKRenderWindowAdapter.h>
#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLState.h>

#include "core/scene/moving_body.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/view3d/camera/camera_style.h"
#include "ui/view3d/camera/orientation_marker.h"
#include "ui/view3d/hand_drag.h"
#include "ui/view3d/scale_bar.h"
#include "ui/view3d/snapshot_glyphs.h"
#include "ui/view3d/view_detail.h"
#include "ui/view3d/view_picture.h"

namespace nearfit::ui {
namespace {

/// Beside it the panels still fit a screen of 800 x 500, and a panel below it has room for some rows [pixels].
constexpr int kLeastWidth = 220, kLeastHeight = 110;
/// Room for moving parts around everything, as a fraction of its size, when the clipping range is kept.
/// Beyond it the kept picture must be redrawn.
constexpr double kRoomForMotion = 0.3;

}  // namespace

void Viewport::setDefaultSurfaceFormat() {
  QSurfaceFormat format = QVTKOpenGLNativeWidget::defaultFormat();
  format.setSamples(0);
  QSurfaceFormat::setDefaultFormat(format);
}

Viewport::Viewport(std::shared_ptr<PartShapeCache> shapes, Selection& selection, ShownPoses& poses,
                   QWidget* parent)
    : QVTKOpenGLNativeWidget(parent),
      shapes_(std::move(shapes)),
      selection_(selection),
      poses_(poses),
      parts_(*renderer_.Get(), shapes_, poses, overlay_.Get()),
      detail_(std::make_unique<ViewDetail>(*renderer_.Get(), *overlay_.Get(), parts_)),
      glyphs_(std::make_unique<SnapshotGlyphs>(*renderer_.Get(), *overlay_.Get(), *this)),
      pace_(std::make_unique<PicturePace>(*this)),
      pictures_(std::make_unique<ViewPicture>(
          ViewPicture::View{*this, *renderer_.Get(), *overlay_.Get(), *marker_.Get(), *detail_})),
      handDrag_(new HandDrag(*this, *renderer_->GetActiveCamera())),
      scaleBar_(new ScaleBar(*this)) {
  setObjectName(QStringLiteral("viewport"));
  setAccessibleName(tr("3-D view"));
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(kLeastWidth, kLeastHeight);
  setInPictures(*scaleBar_);
  setUpRenderers();
  setUpInteraction();
  connect(detail_.get(), &ViewDetail::pictureWanted, this, &Viewport::requestRender);
  connect(detail_.get(), &ViewDetail::depthsNeeded, this,
          [this] { fitDepths(*renderer_, drawnBounds(), kRoomForMotion); });
  connect(pace_.get(), &PicturePace::pictureDue, this, [this] { window_->Render(); });
  connect(&selection_, &Selection::changed, this, &Viewport::showSelection);
  connect(&poses_, &ShownPoses::changed, this, &Viewport::placeParts);
}

Viewport::~Viewport() = default;

void Viewport::changeEvent(QEvent* event) {
  QVTKOpenGLNativeWidget::changeEvent(event);
  if (event->type() != QEvent::PaletteChange) return;
  setUpBackground(*renderer_);
  parts_.followTheme();
  requestRender();
}

void Viewport::setUpRenderers() {
  // Software OpenGL has no cheap multisampling; FXAA smooths there too.
  window_->SetMultiSamples(0);
  setRenderWindow(window_);
  // Each picture covers the last one, so nothing needs clearing.
  setUpdateBehavior(PartialUpdate);
  window_->SetNumberOfLayers(2);
  window_->AddRenderer(renderer_);
  window_->AddRenderer(overlay_);

  renderer_->SetLayer(0);
  setUpBackground(*renderer_);
  setUpLights(*renderer_);
  renderer_->GetActiveCamera()->SetViewAngle(24.0);

  // Parts would hide minima, which lie in gaps between them: draw the overlay over everything.
  overlay_->SetLayer(1);
  overlay_->SetActiveCamera(renderer_->GetActiveCamera());
  overlay_->InteractiveOff();
}

void Viewport::setUpInteraction() {
  vtkNew<CameraStyle> style;
  interactor()->SetInteractorStyle(style);
  style->SetDefaultRenderer(renderer_);
  style->onMoved([this] { requestRender(); });
  style->AutoAdjustCameraClippingRangeOff();
  setUpOrientationMarker(*marker_.Get(), *renderer_.Get());
  renderer_->AddObserver(vtkCommand::StartEvent, this, &Viewport::prepareRender);
  window_->AddObserver(vtkCommand::EndEvent, this, &Viewport::countPicture);
}

void Viewport::paintGL() {
  vtkOpenGLState* state = window_->GetState();
  state->Reset();
  state->Push();
  // VTK's default; Qt's differs.
  state->vtkglDepthFunc(GL_LEQUAL);
  RenderWindowAdapter->paint();
  // Observers may have drawn elsewhere.
  makeCurrent();
  // The superclass would rescale the picture, which takes software OpenGL as long as drawing it.
  const int* size = window_->GetRenderFramebuffer()->GetLastSize();
  state->vtkglBindFramebuffer(GL_DRAW_FRAMEBUFFER, defaultFramebufferObject());
  state->vtkglDisable(GL_SCISSOR_TEST);
  window_->BlitDisplayFramebuffer(0, 0, 0, size[0], size[1], 0, 0, size[0], size[1], GL_COLOR_BUFFER_BIT,
                                  GL_NEAREST);
  // Blending translucent parts leaves alpha below 1, but the window must be opaque.
  state->vtkglColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_TRUE);
  state->vtkglClearColor(0.0F, 0.0F, 0.0F, 1.0F);
  state->vtkglClear(GL_COLOR_BUFFER_BIT);
  state->Pop();
}

void Viewport::countPicture() {
  ++pictureCount_;
  pace_->noteDrawn();
  detail_->afterPicture();
  showScale();
  if (std::exchange(hasNewNumbers_, false) && shown_ != nullptr) emit snapshotDrawn(*shown_);
  emit drawn();
}

void Viewport::showScale() {
  double bounds[6];
  const double* focus = renderer_->GetActiveCamera()->GetFocalPoint();
  const double scale = projection().metresPerPixel({focus[0], focus[1], focus[2]});
  scaleBar_->showScale(parts_.visibleBounds(bounds) ? scale : 0.0);
}

void Viewport::prepareRender() {
  // Nothing else tells the marker the window's first size.
  marker_->SquareResize();
  if (hasNewNumbers_ && shown_ != nullptr) isFelt_ ? glyphs_->showNumbers(*shown_) : glyphs_->hideNumbers();
  parts_.updateCut();
  glyphs_->hand().setCut(parts_.cutOfMoving());
  adjustClipping();
  detail_->beforePicture();
}

void Viewport::adjustClipping() {
  const vtkBoundingBox needed = drawnBounds();
  if (!detail_->holdsDepths()) return fitDepths(*renderer_, needed);
  // A kept picture stays valid until something leaves its clipping range.
  if (!keepDepths(*renderer_, needed)) detail_->drop();
}

vtkBoundingBox Viewport::drawnBounds() {
  vtkBoundingBox box;
  double bounds[6];
  if (parts_.visibleBounds(bounds)) box.AddBounds(bounds);
  if (glyphs_->hand().visibleBounds(bounds)) box.AddBounds(bounds);
  // Arrows reach beyond the parts.
  overlay_->ComputeVisiblePropBounds(bounds);
  if (bounds[0] <= bounds[1]) box.AddBounds(bounds);
  return box;
}

void Viewport::requestRender() {
  pace_->request();
}

void Viewport::completePicture() {
  detail_->complete();
  window_->Render();
}

void Viewport::setScene(const Scene& scene) {
  // Parts that undo brings back are known, so the camera stays.
  bool isAnotherScene = true;
  for (const Scene::PartPtr& part : scene.parts())
    isAnotherScene = known_.insert(part->id).second && isAnotherScene;
  scene_ = scene;
  parts_.setScene(scene);
  showMovingPart();
  if (isAnotherScene) setView(StandardView::Isometric);
  emit posesChanged();
  requestRender();
}

void Viewport::takeNewShapes() {
  if (!parts_.takeNewShapes()) return;
  showMovingPart();
  requestRender();
}

void Viewport::showMovingPart() {
  movingSize_ = sizeOfMoving(scene_);
  std::vector<HandGhost::Piece> pieces;
  const Part* lead = scene_.movingPart() ? scene_.find(*scene_.movingPart()) : nullptr;
  for (const PartId id : scene_.movingParts()) {
    const Part& part = scene_.get(id);
    const bool isDrawn = part.isVisible || !scene_.movingGroup();
    if (!isDrawn || part.geometry == nullptr) continue;
    pieces.push_back({shapes_->shapeOf(part.geometry),
                      id == lead->id ? RigidTransform{}
                                     : (lead->worldFromPart.inverse() * part.worldFromPart).normalized()});
  }
  glyphs_->hand().setPieces(std::move(pieces));
}

void Viewport::showSelection() {
  parts_.setSelected(selection_.parts());
  requestRender();
}

void Viewport::highlight(const std::vector<PartId>& parts) {
  parts_.setHighlighted(parts);
  requestRender();
}

void Viewport::setColours(const SceneRenderer::Colours& colours, bool isStale) {
  if (parts_.setColours(colours, isStale)) requestRender();
}

void Viewport::placeParts(const std::vector<PartId>& parts) {
  parts_.place(parts);
  emit posesChanged();
  requestRender();
}

void Viewport::showSnapshot(const ServoSnapshot& snapshot) {
  takeSnapshot(snapshot, true);
}

void Viewport::showGhost(const ServoSnapshot& ghost) {
  takeSnapshot(ghost, false);
}

void Viewport::takeSnapshot(const ServoSnapshot& snapshot, bool isFelt) {
  const bool isSame = shown_ != nullptr && !isPast_ && isFelt == isFelt_ && looksTheSame(*shown_, snapshot) &&
                      !glyphs_->minima().isDue(snapshot.time);
  isFelt_ = isFelt;
  if (shown_ == nullptr) shown_ = std::make_unique<ServoSnapshot>();
  *shown_ = snapshot;
  if (!isSame) draw(snapshot);
  if (hasNewNumbers_ && isVisible()) return;
  emit snapshotDrawn(snapshot);
}

void Viewport::draw(const ServoSnapshot& snapshot) {
  isPast_ = false;
  glyphs_->setPast(false);
  detail_->setFeeling(true);
  hasNewNumbers_ = true;
  glyphs_->show(snapshot, scene_.haptics(), movingSize_);
  const std::size_t overlapping =
      std::min<std::size_t>(snapshot.overlappingCount, ServoSnapshot::kMaxOverlapping);
  parts_.setOverlapping(std::span(snapshot.overlapping).first(overlapping));
  requestRender();
}

void Viewport::keepSnapshot() {
  if (shown_ == nullptr || !isFelt_) return;
  isPast_ = true;
  detail_->setFeeling(false);
  glyphs_->setPast(true);
  glyphs_->showNumbers(*shown_);
  parts_.setOverlapping({});
  requestRender();
}

void Viewport::clearSnapshot() {
  shown_.reset();
  isPast_ = false;
  detail_->setFeeling(false);
  glyphs_->clear();
  parts_.setOverlapping({});
  requestRender();
}

void Viewport::fit() {
  double bounds[6];
  if (!parts_.visibleBounds(bounds)) return;
  fitView(*renderer_, bounds);
  requestRender();
}

void Viewport::fitParts(const std::vector<PartId>& parts) {
  // Room for neighbours and arrows, as a fraction of the parts' size.
  constexpr double kRoom = 0.1;
  vtkBoundingBox whole;
  std::vector<vtkBoundingBox> boxes;
  for (const PartId part : parts) {
    double bounds[6];
    if (!parts_.boundsOf(part, bounds)) continue;
    boxes.emplace_back(bounds);
    whole.AddBounds(bounds);
  }
  if (boxes.empty()) return;
  for (vtkBoundingBox& box : boxes)
    box.Inflate(kRoom * whole.GetMaxLength());
  fitView(*renderer_, boxes);
  requestRender();
}

void Viewport::fitBox(const Aabb& box) {
  if (box.isEmpty()) return;
  const double bounds[6] = {box.lower.x, box.upper.x, box.lower.y, box.upper.y, box.lower.z, box.upper.z};
  fitView(*renderer_, bounds);
  requestRender();
}

void Viewport::setView(StandardView view) {
  double bounds[6];
  if (!parts_.visibleBounds(bounds)) return;
  setStandardView(*renderer_, view, bounds);
  requestRender();
}

void Viewport::setOrthographic(bool isOrthographic) {
  ui::setOrthographic(*renderer_->GetActiveCamera(), isOrthographic);
  requestRender();
}

void Viewport::setSeeThrough(bool isSeeThrough) {
  parts_.setSeeThrough(isSeeThrough);
  requestRender();
}

void Viewport::setEdgesVisible(bool isVisible) {
  parts_.setEdgesVisible(isVisible);
  requestRender();
}

void Viewport::setMinimaVisible(bool isVisible) {
  glyphs_->minima().setVisible(isVisible);
  requestRender();
}

void Viewport::setMinimaChoice(const MinimaChoice& choice) {
  glyphs_->minima().setChoice(choice);
  hasNewNumbers_ = shown_ != nullptr;
  if (shown_ != nullptr) glyphs_->show(*shown_, scene_.haptics(), movingSize_);
  requestRender();
}

void Viewport::setContactsVisible(bool isVisible) {
  glyphs_->contacts().setVisible(isVisible);
  requestRender();
}

void Viewport::setHandVisible(bool isVisible) {
  glyphs_->hand().setVisible(isVisible);
  requestRender();
}

void Viewport::setWrenchVisible(bool isVisible) {
  glyphs_->arrows().setVisible(isVisible);
  requestRender();
}

void Viewport::setScaleBarVisible(bool isVisible) {
  scaleBar_->setWanted(isVisible);
}

void Viewport::setLegendVisible(bool isVisible) {
  glyphs_->setLegendVisible(isVisible);
}

void Viewport::mousePressEvent(QMouseEvent* event) {
  pressedAt_ = event->pos();
  QVTKOpenGLNativeWidget::mousePressEvent(event);
}

void Viewport::mouseReleaseEvent(QMouseEvent* event) {
  QVTKOpenGLNativeWidget::mouseReleaseEvent(event);
  const bool isClick = (event->pos() - pressedAt_).manhattanLength() < QApplication::startDragDistance() / 2;
  if (event->button() == Qt::LeftButton && isClick) pickAt(event->pos(), event->modifiers());
}

ViewProjection Viewport::projection() const {
  return {projectionCamera(*renderer_->GetActiveCamera()), {width(), height()}};
}

Aabb Viewport::visibleBounds() const {
  Aabb box;
  double bounds[6];
  if (!parts_.visibleBounds(bounds)) return box;
  box.add({bounds[0], bounds[2], bounds[4]});
  box.add({bounds[1], bounds[3], bounds[5]});
  return box;
}

void Viewport::setCut(const std::optional<ViewCut>& cut) {
  parts_.setCut(cut);
  requestRender();
}

std::optional<PickedPoint> Viewport::pointAt(const QPoint& position, SeenThrough seenThrough,
                                             const IsNearAt& isNearAt) {
  const double scale = devicePixelRatioF();
  return parts_.pickPoint(position.x() * scale, (height() - 1 - position.y()) * scale, seenThrough, isNearAt);
}

std::vector<PartId> Viewport::partsIn(const QRect& place) const {
  const QRect seen = place.normalized().intersected(rect());
  if (seen.isEmpty()) return {};
  return parts_.seenIn(projection(), {{seen.left(), seen.top()}, {seen.right(), seen.bottom()}});
}

void Viewport::pickAt(const QPoint& position, Qt::KeyboardModifiers modifiers) {
  const std::optional<PickedPoint> picked = pointAt(position);
  const std::optional<PartId> part = picked ? std::optional(picked->part) : std::nullopt;
  const bool isToggled = modifiers.testFlag(Qt::ControlModifier);
  // With Ctrl or Shift, a click that misses all parts keeps the selection.
  if (!isToggled && !modifiers.testFlag(Qt::ShiftModifier)) return selection_.select(part);
  if (part) isToggled ? selection_.toggle(*part) : selection_.add(*part);
}

void Viewport::keyPressEvent(QKeyEvent* event) {
  const auto step = [&](int x, int y, int z) {
    event->modifiers().testFlag(Qt::ShiftModifier) ? emit turned(x, y, z) : emit nudged(x, y, z);
  };
  switch (event->key()) {
    case Qt::Key_Left:
      return step(-1, 0, 0);
    case Qt::Key_Right:
      return step(1, 0, 0);
    case Qt::Key_Up:
      return step(0, 1, 0);
    case Qt::Key_Down:
      return step(0, -1, 0);
    case Qt::Key_PageUp:
      return step(0, 0, 1);
    case Qt::Key_PageDown:
      return step(0, 0, -1);
    default:
      QVTKOpenGLNativeWidget::keyPressEvent(event);
  }
}

void Viewport::resizeEvent(QResizeEvent* event) {
  QVTKOpenGLNativeWidget::resizeEvent(event);
  glyphs_->placeLegend();
}

}  // namespace nearfit::ui
