#include "ui/viewport.h"

#include <QApplication>
#include <QEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QScreen>
#include <QSurfaceFormat>
#include <QTimer>
#include <algorithm>

#include <glm/trigonometric.hpp>
#include <vtkBoundingBox.h>
#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkLightKit.h>
#include <vtkObjectFactory.h>
#include <vtkRenderWindowInteractor.h>

#include "ui/colour_legend.h"
#include "ui/detail/view_detail.h"
#include "ui/hand_drag.h"
#include "ui/orientation_marker.h"
#include "ui/selection.h"
#include "ui/snapshot_look.h"
#include "ui/theme.h"

namespace nearfit::ui {
namespace {

/// VTK's style without its letter keys, some of which end the program or switch to stereo.
class CameraStyle : public vtkInteractorStyleTrackballCamera {
 public:
  static CameraStyle* New() { VTK_STANDARD_NEW_BODY(CameraStyle); }
  void OnChar() override {}
  void OnKeyPress() override {}
  void OnMouseMove() override {
    atNextPicture([this] { Superclass::OnMouseMove(); });
  }
  void OnMouseWheelForward() override {
    atNextPicture([this] { Superclass::OnMouseWheelForward(); });
  }
  void OnMouseWheelBackward() override {
    atNextPicture([this] { Superclass::OnMouseWheelBackward(); });
  }

  Viewport* view = nullptr;

 private:
  using Superclass = vtkInteractorStyleTrackballCamera;

  /// VTK would draw a picture for each event, however many come between two pictures of the display.
  template <typename Act>
  void atNextPicture(const Act& act) {
    vtkRenderWindowInteractor* interactor = GetInteractor();
    interactor->EnableRenderOff();
    vtkCamera* camera = view->camera();
    const vtkMTimeType before = camera->GetMTime();
    act();
    const bool hasChanged = camera->GetMTime() != before;
    interactor->EnableRenderOn();
    if (hasChanged) view->requestRender();
  }
};

/// So far may what moves leave the bounds of all, in parts of their size, before what is kept is drawn anew.
constexpr double kRoomForMotion = 0.3;

}  // namespace

void Viewport::setDefaultSurfaceFormat() {
  QSurfaceFormat format = QVTKOpenGLNativeWidget::defaultFormat();
  format.setSamples(0);
  QSurfaceFormat::setDefaultFormat(format);
}

Viewport::Viewport(std::shared_ptr<PartShapeCache> shapes, Selection& selection, QWidget* parent)
    : QVTKOpenGLNativeWidget(parent),
      shapes_(std::move(shapes)),
      selection_(selection),
      parts_(*renderer_.Get(), shapes_, overlay_.Get()),
      detail_(std::make_unique<ViewDetail>(*renderer_.Get(), *overlay_.Get(), parts_)),
      hand_(*renderer_.Get(), *overlay_.Get()),
      minima_(*overlay_.Get()),
      contacts_(*overlay_.Get()),
      arrows_(*overlay_.Get()),
      legend_(new ColourLegend(this)),
      handDrag_(new HandDrag(*this, *renderer_->GetActiveCamera())) {
  setObjectName(QStringLiteral("viewport"));
  setAccessibleName(tr("3-D view"));
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(320, 240);
  setUpRenderers();
  setUpInteraction();
  connect(detail_.get(), &ViewDetail::pictureWanted, this, &Viewport::requestRender);
  connect(detail_.get(), &ViewDetail::depthsNeeded, this, [this] { fitDepths(kRoomForMotion); });
  connect(&selection_, &Selection::changed, this, &Viewport::showSelection);
  legend_->hide();
}

Viewport::~Viewport() = default;

void Viewport::changeEvent(QEvent* event) {
  QVTKOpenGLNativeWidget::changeEvent(event);
  if (event->type() != QEvent::PaletteChange) return;
  setUpBackground();
  requestRender();
}

void Viewport::setUpBackground() {
  renderer_->GradientBackgroundOn();
  if (isThemeDark()) {
    renderer_->SetBackground(0.27, 0.31, 0.36);
    renderer_->SetBackground2(0.13, 0.15, 0.18);
  } else {
    renderer_->SetBackground(0.72, 0.78, 0.85);
    renderer_->SetBackground2(0.955, 0.968, 0.98);
  }
}

void Viewport::setUpRenderers() {
  // Software OpenGL has no cheap multisampling; FXAA smooths there too.
  window_->SetMultiSamples(0);
  setRenderWindow(window_);
  window_->SetNumberOfLayers(2);
  window_->AddRenderer(renderer_);
  window_->AddRenderer(overlay_);

  renderer_->SetLayer(0);
  setUpBackground();
  renderer_->GetActiveCamera()->SetViewAngle(24.0);
  vtkNew<vtkLightKit> lights;
  lights->SetKeyLightIntensity(0.92);
  lights->SetKeyToFillRatio(2.0);
  lights->SetKeyToHeadRatio(2.2);
  lights->AddLightsToRenderer(renderer_);

  // Minima lie in the gaps between parts: drawn over everything, or the parts would hide them.
  overlay_->SetLayer(1);
  overlay_->SetActiveCamera(renderer_->GetActiveCamera());
  overlay_->InteractiveOff();
}

void Viewport::setUpInteraction() {
  vtkNew<CameraStyle> style;
  interactor()->SetInteractorStyle(style);
  style->SetDefaultRenderer(renderer_);
  style->view = this;
  style->AutoAdjustCameraClippingRangeOff();
  setUpOrientationMarker(*marker_.Get(), *renderer_.Get());
  renderer_->AddObserver(vtkCommand::StartEvent, this, &Viewport::prepareRender);
  window_->AddObserver(vtkCommand::EndEvent, this, &Viewport::countPicture);
}

void Viewport::countPicture() {
  ++pictureCount_;
  sincePicture_.start();
  detail_->afterPicture();
  emit drawn();
}

void Viewport::prepareRender() {
  // The marker learns of the window's first size from nobody.
  marker_->SquareResize();
  parts_.updateCut();
  hand_.setCut(parts_.cutOfMoving());
  adjustClipping();
  detail_->beforePicture();
}

void Viewport::adjustClipping() {
  if (!detail_->holdsDepths()) return fitDepths(0.0);
  // Depths that are kept stay right, unless something left them.
  double kept[2];
  vtkCamera& camera = *renderer_->GetActiveCamera();
  camera.GetClippingRange(kept);
  fitDepths(0.0);
  const double* needed = camera.GetClippingRange();
  // From within the scene VTK begins at a part of the farthest depth, which room around it makes no nearer.
  const bool beginsAtTheEye = kept[0] <= 1.01 * renderer_->GetNearClippingPlaneTolerance() * kept[1];
  if ((needed[0] >= kept[0] || beginsAtTheEye) && needed[1] <= kept[1]) {
    camera.SetClippingRange(kept);
  } else {
    detail_->drop();
  }
}

void Viewport::fitDepths(double room) {
  vtkBoundingBox box;
  double bounds[6];
  if (parts_.visibleBounds(bounds)) box.AddBounds(bounds);
  if (hand_.visibleBounds(bounds)) box.AddBounds(bounds);
  // Arrows stand out of the parts.
  overlay_->ComputeVisiblePropBounds(bounds);
  if (bounds[0] <= bounds[1]) box.AddBounds(bounds);
  if (box.IsValid() == 0) return;
  box.Inflate(room * box.GetMaxLength());
  box.GetBounds(bounds);
  renderer_->ResetCameraClippingRange(bounds);
}

void Viewport::requestRender() {
  if (hasRequest_) return;
  hasRequest_ = true;
  // At most as many as the display shows.
  const QScreen* screen = window()->screen();
  const auto interval = static_cast<qint64>(1000.0 / std::max(30.0, screen->refreshRate()));
  const qint64 since = sincePicture_.isValid() ? sincePicture_.elapsed() : interval;
  QTimer::singleShot(static_cast<int>(std::max<qint64>(0, interval - since)), Qt::PreciseTimer, this, [this] {
    hasRequest_ = false;
    if (isVisible()) window_->Render();
  });
}

void Viewport::completePicture() {
  detail_->complete();
  window_->Render();
}

void Viewport::setScene(const Scene& scene) {
  const bool isAnotherScene =
      std::none_of(scene.parts().begin(), scene.parts().end(),
                   [this](const Scene::PartPtr& part) { return scene_.find(part->id) != nullptr; });
  scene_ = scene;
  parts_.setScene(scene);
  showMovingPart();
  legend_->setCutoff(scene.haptics().springs.cutoff);
  if (isAnotherScene) setView(StandardView::Isometric);
  emit posesChanged();
  requestRender();
}

void Viewport::showMovingPart() {
  const Part* part = scene_.movingPart() ? scene_.find(*scene_.movingPart()) : nullptr;
  hand_.setShape(part != nullptr ? shapes_->shapeOf(part->geometry) : nullptr);
}

void Viewport::showSelection() {
  parts_.setSelected(selection_.parts());
  requestRender();
}

void Viewport::showSnapshot(const ServoSnapshot& snapshot) {
  if (shown_ != nullptr && looksTheSame(*shown_, snapshot)) return;
  if (shown_ == nullptr) shown_ = std::make_unique<ServoSnapshot>();
  *shown_ = snapshot;
  parts_.setPoseInHand(snapshot.proxy);
  const double cutoff = scene_.haptics().springs.cutoff;
  minima_.show(std::span(snapshot.lmds).first(snapshot.storedLmds), cutoff);
  const Part* moving = scene_.find(snapshot.moving);
  const double size = moving != nullptr ? moving->geometry->mesh.bounds().diagonal() : 0.0;
  arrows_.show(snapshot.centre, snapshot.wrench, size);
  contacts_.show(std::span(snapshot.contacts).first(snapshot.storedContacts), size);
  hand_.show(snapshot, size);
  const std::size_t released = std::min<std::size_t>(snapshot.releasedCount, ServoSnapshot::kMaxReleased);
  parts_.setOverlapping(std::span(snapshot.released).first(released));
  legend_->showSnapshot(snapshot);
  placeLegend();
  legend_->show();
  emit posesChanged();
  requestRender();
}

void Viewport::clearSnapshot() {
  shown_.reset();
  parts_.setPoseInHand(std::nullopt);
  minima_.clear();
  arrows_.clear();
  contacts_.clear();
  hand_.clear();
  parts_.setOverlapping({});
  legend_->hide();
  emit posesChanged();
  requestRender();
}

void Viewport::fit() {
  double bounds[6];
  if (!parts_.visibleBounds(bounds)) return;
  fitView(*renderer_, bounds);
  requestRender();
}

void Viewport::fitParts(const std::vector<PartId>& parts) {
  // Room around them for their neighbours and for arrows.
  constexpr double kRoom = 0.45;
  double bounds[6];
  vtkBoundingBox box;
  for (const PartId part : parts) {
    if (parts_.boundsOf(part, bounds)) box.AddBounds(bounds);
  }
  if (box.IsValid() == 0) return;
  box.Inflate(kRoom * box.GetMaxLength());
  box.GetBounds(bounds);
  fitView(*renderer_, bounds);
  requestRender();
}

void Viewport::setView(StandardView view) {
  double bounds[6];
  if (!parts_.visibleBounds(bounds)) return;
  setStandardView(*renderer_, view, bounds);
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
  minima_.setVisible(isVisible);
  requestRender();
}

void Viewport::setContactsVisible(bool isVisible) {
  contacts_.setVisible(isVisible);
  requestRender();
}

void Viewport::setHandVisible(bool isVisible) {
  hand_.setVisible(isVisible);
  requestRender();
}

void Viewport::setWrenchVisible(bool isVisible) {
  arrows_.setVisible(isVisible);
  requestRender();
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

void Viewport::setDragged(std::map<PartId, RigidTransform> worldFromPart) {
  parts_.setDragged(std::move(worldFromPart));
  emit posesChanged();
  requestRender();
}

std::optional<RigidTransform> Viewport::shownPose(PartId part) const {
  const Part* found = scene_.find(part);
  return found != nullptr ? std::optional(parts_.shownPose(*found)) : std::nullopt;
}

ViewProjection Viewport::projection() const {
  vtkCamera& seen = *renderer_->GetActiveCamera();
  const auto vectorOf = [](const double* v) { return glm::dvec3(v[0], v[1], v[2]); };
  ViewProjection::Camera camera;
  camera.eye = vectorOf(seen.GetPosition());
  camera.away = vectorOf(seen.GetDirectionOfProjection());
  camera.up = vectorOf(seen.GetViewUp());
  camera.isParallel = seen.GetParallelProjection() != 0;
  camera.viewAngle = glm::radians(seen.GetViewAngle());
  camera.halfHeight = seen.GetParallelScale();
  return {camera, {width(), height()}};
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

std::optional<PickedPoint> Viewport::pointAt(const QPoint& position) {
  const double scale = devicePixelRatioF();
  return parts_.pickPoint(position.x() * scale, (height() - 1 - position.y()) * scale);
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
  // A click beside a part that was to be added loses nothing of what is selected.
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
  placeLegend();
}

void Viewport::placeLegend() {
  constexpr int kMargin = 14;
  legend_->move(kMargin, height() - legend_->height() - kMargin);
}

}  // namespace nearfit::ui
