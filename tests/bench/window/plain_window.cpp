#include "tests/bench/window/plain_window.h"

#include <QApplication>
#include <map>

#include <QVTKOpenGLNativeWidget.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellPicker.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkMatrix4x4.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderer.h>

#include "tests/bench/window/bench_window.h"
#include "ui/view3d/parts/part_shape.h"
#include "ui/view3d/vtk/vtk_convert.h"

namespace nearfit::bench {

struct PlainWindow::Impl {
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  std::map<const PartGeometry*, vtkSmartPointer<vtkPolyData>> surfaces;
  QVTKOpenGLNativeWidget widget;
  int swaps = 0;
};

PlainWindow::PlainWindow(const Scene& scene) : impl_(std::make_unique<Impl>()) {
  impl_->widget.setRenderWindow(impl_->window);
  impl_->window->SetMultiSamples(0);
  impl_->window->AddRenderer(impl_->renderer);
  for (const Scene::PartPtr& part : scene.parts()) {
    vtkSmartPointer<vtkPolyData>& surface = impl_->surfaces[part->geometry.get()];
    if (surface == nullptr) surface = ui::makePartShape(part->geometry->mesh).surface;
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(surface);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    vtkNew<vtkMatrix4x4> pose;
    ui::setMatrix(*pose, part->worldFromPart);
    actor->SetUserMatrix(pose);
    impl_->renderer->AddActor(actor);
  }
  impl_->widget.resize(1280, 800);
  QObject::connect(&impl_->widget, &QOpenGLWidget::frameSwapped, &impl_->widget, [this] { ++impl_->swaps; });
  impl_->renderer->ResetCamera();
  impl_->widget.show();
  waitUntil("its first picture", [this] { return impl_->swaps > 0; });
}

PlainWindow::~PlainWindow() = default;

std::vector<double> PlainWindow::orbit(std::chrono::milliseconds time) {
  constexpr double kDegrees = 2.0;
  std::vector<double> frames;
  const double end = milliseconds() + static_cast<double>(time.count());
  while (milliseconds() < end) {
    const double start = milliseconds();
    const int before = impl_->swaps;
    impl_->renderer->GetActiveCamera()->Azimuth(kDegrees);
    impl_->renderer->ResetCameraClippingRange();
    impl_->window->Render();
    waitUntil("a picture", [&] { return impl_->swaps > before; });
    frames.push_back(milliseconds() - start);
  }
  return frames;
}

void PlainWindow::pickAt(const QPoint& position) {
  vtkNew<vtkCellPicker> picker;
  picker->Pick(position.x(), impl_->widget.height() - 1 - position.y(), 0.0, impl_->renderer);
}

}  // namespace nearfit::bench
