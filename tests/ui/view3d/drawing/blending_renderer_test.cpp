#include <QtTest>
#include <cmath>

#include <QVTKOpenGLNativeWidget.h>
#include <vtkActor.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkPlaneSource.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "tests/support/qt/qt_patience.h"
#include "tests/support/qt/qt_suite.h"
#include "ui/view3d/drawing/caching_renderer.h"
#include "ui/view3d/viewport.h"

using namespace nearfit;

namespace {

constexpr double kBackground = 0.2, kColour = 0.9;
/// Of both squares, which lie over each other; the one that is added first lies in front.
constexpr double kFront = 0.3, kBack = 0.6;

/// A view of two squares that shine through, seen from in front.
struct Squares {
  Squares() {
    window->SetMultiSamples(0);
    view.setRenderWindow(window);
    window->AddRenderer(renderer);
    renderer->SetBackground(kBackground, kBackground, kBackground);
    add(0.1, kFront);
    add(-0.1, kBack);
    view.resize(200, 200);
    view.show();
  }
  void add(double z, double opacity) {
    vtkNew<vtkPlaneSource> square;
    square->SetCenter(0.0, 0.0, z);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(square->GetOutputPort());
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    vtkProperty* look = actor->GetProperty();
    look->LightingOff();
    look->SetColor(kColour, kColour, kColour);
    look->SetOpacity(opacity);
    renderer->AddActor(actor);
  }
  int grey() {
    window->Render();
    const QImage picture = view.grabFramebuffer();
    return qGreen(picture.pixel(picture.width() / 2, picture.height() / 2));
  }

  vtkNew<vtkGenericOpenGLRenderWindow> window;
  vtkNew<ui::BlendingRenderer> renderer;
  QVTKOpenGLNativeWidget view;
};

}  // namespace

class BlendingRendererTest : public QObject {
  Q_OBJECT

 private slots:
  void oneColourIsAsRightInAnyOrder();
  void aWayBackAndForthChangesNothing();
};

void BlendingRendererTest::oneColourIsAsRightInAnyOrder() {
  Squares squares;
  QVERIFY(QTest::qWaitForWindowExposed(&squares.view));
  // What is behind shines through both.
  const double left = (1.0 - kFront) * (1.0 - kBack);
  const double expected = 255.0 * (kColour + (kBackground - kColour) * left);
  const int seen = squares.grey();
  QVERIFY2(std::abs(seen - expected) <= 2.0,
           qPrintable(QStringLiteral("%1, not %2").arg(seen).arg(expected)));
}

void BlendingRendererTest::aWayBackAndForthChangesNothing() {
  Squares squares;
  QVERIFY(QTest::qWaitForWindowExposed(&squares.view));
  const int before = squares.grey();
  squares.renderer->setManyColoured(true);
  const int byPasses = squares.grey();
  squares.renderer->setManyColoured(false);
  QCOMPARE(squares.grey(), before);
  QVERIFY2(std::abs(byPasses - before) <= 2, qPrintable(QStringLiteral("%1, %2").arg(byPasses).arg(before)));
}

NEARFIT_QT_SUITE(BlendingRendererTest, [](int argc, char** argv) {
  ui::Viewport::setDefaultSurfaceFormat();
  return test::runQtTest<BlendingRendererTest>(argc, argv);
})
#include "blending_renderer_test.moc"
