#include "ui/viewport.h"

#include <QApplication>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QSurfaceFormat>
#include <QTimer>
#include <algorithm>

#include <vtkBoundingBox.h>
#include <vtkCamera.h>
#include <vtkCameraOrientationRepresentation.h>
#include <vtkCommand.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkLightKit.h>
#include <vtkObjectFactory.h>
#include <vtkRenderWindowInteractor.h>

#include "ui/colour_legend.h"
#include "ui/snapshot_look.h"

namespace nearfit::ui {
namespace {

/// VTK's style without its letter keys, some of which end the program or switch to stereo.
class CameraStyle : public vtkInteractorStyleTrackballCamera {
 public:
  static CameraStyle* New() { VTK_STANDARD_NEW_BODY(CameraStyle); }
  void OnChar() override {}
  void OnKeyPress() override {}
};

}  // namespace

void Viewport::setDefaultSurfaceFormat() {
  QSurfaceFormat format = QVTKOpenGLNativeWidget::defaultFormat();
  format.setSamples(0);
  QSurfaceFormat::setDefaultFormat(format);
}

Viewport::Viewport(std::shared_ptr<PartShapeCache> shapes, QWidget* parent)
    : QVTKOpenGLNativeWidget(parent),
      shapes_(std::move(shapes)),
      parts_(*renderer_.Get(), shapes_),
      hand_(*renderer_.Get(), *overlay_.Get()),
      minima_(*overlay_.Get()),
      contacts_(*overlay_.Get()),
      arrows_(*overlay_.Get()),
      legend_(new ColourLegend(this)) {
  setObjectName(QStringLiteral("viewport"));
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(320, 240);
  setUpRenderers();
  setUpInteraction();
  legend_->hide();
}

Viewport::~Viewport() = default;

void Viewport::setUpRenderers() {
  // Software OpenGL has no cheap multisampling; FXAA smooths there too.
  window_->SetMultiSamples(0);
  setRenderWindow(window_);
  window_->SetNumberOfLayers(2);
  window_->AddRenderer(renderer_);
  window_->AddRenderer(overlay_);

  renderer_->SetLayer(0);
  renderer_->GradientBackgroundOn();
  renderer_->SetBackground(0.72, 0.78, 0.85);
  renderer_->SetBackground2(0.955, 0.968, 0.98);
  renderer_->UseFXAAOn();
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
  overlay_->UseFXAAOn();
}

void Viewport::setUpInteraction() {
  vtkNew<CameraStyle> style;
  interactor()->SetInteractorStyle(style);
  style->SetDefaultRenderer(renderer_);
  style->AutoAdjustCameraClippingRangeOff();
  marker_->SetParentRenderer(renderer_);
  auto* shape = vtkCameraOrientationRepresentation::SafeDownCast(marker_->GetRepresentation());
  shape->SetSize(100, 100);
  marker_->On();
  renderer_->AddObserver(vtkCommand::StartEvent, this, &Viewport::prepareRender);
  window_->AddObserver(vtkCommand::EndEvent, this, &Viewport::countPicture);
}

void Viewport::countPicture() {
  ++pictureCount_;
}

void Viewport::prepareRender() {
  // The marker learns of the window's first size from nobody.
  marker_->SquareResize();
  adjustClipping();
}

void Viewport::adjustClipping() {
  vtkBoundingBox box;
  double bounds[6];
  if (parts_.visibleBounds(bounds)) box.AddBounds(bounds);
  if (hand_.visibleBounds(bounds)) box.AddBounds(bounds);
  // Arrows stand out of the parts.
  overlay_->ComputeVisiblePropBounds(bounds);
  if (bounds[0] <= bounds[1]) box.AddBounds(bounds);
  if (box.IsValid() == 0) return;
  box.GetBounds(bounds);
  renderer_->ResetCameraClippingRange(bounds);
}

void Viewport::requestRender() {
  if (hasRequest_) return;
  hasRequest_ = true;
  QTimer::singleShot(0, this, [this] {
    hasRequest_ = false;
    if (isVisible()) window_->Render();
  });
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
  requestRender();
}

void Viewport::showMovingPart() {
  const Part* part = scene_.movingPart() ? scene_.find(*scene_.movingPart()) : nullptr;
  hand_.setShape(part != nullptr ? shapes_->shapeOf(part->geometry) : nullptr);
}

void Viewport::setSelected(std::optional<PartId> part) {
  parts_.setSelected(part);
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
  requestRender();
}

void Viewport::fit() {
  double bounds[6];
  if (!parts_.visibleBounds(bounds)) return;
  fitView(*renderer_, bounds);
  requestRender();
}

void Viewport::fitPart(PartId part) {
  // Room around it for its neighbours and for arrows.
  constexpr double kRoom = 0.45;
  double bounds[6];
  if (!parts_.boundsOf(part, bounds)) return;
  vtkBoundingBox box(bounds);
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
  if (event->button() == Qt::LeftButton && isClick) pickAt(event->pos());
}

void Viewport::pickAt(const QPoint& position) {
  const double scale = devicePixelRatioF();
  emit partPicked(parts_.pick(position.x() * scale, (height() - 1 - position.y()) * scale));
}

void Viewport::keyPressEvent(QKeyEvent* event) {
  switch (event->key()) {
    case Qt::Key_Left:
      emit nudged(-1, 0, 0);
      return;
    case Qt::Key_Right:
      emit nudged(1, 0, 0);
      return;
    case Qt::Key_Up:
      emit nudged(0, 1, 0);
      return;
    case Qt::Key_Down:
      emit nudged(0, -1, 0);
      return;
    case Qt::Key_PageUp:
      emit nudged(0, 0, 1);
      return;
    case Qt::Key_PageDown:
      emit nudged(0, 0, -1);
      return;
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
