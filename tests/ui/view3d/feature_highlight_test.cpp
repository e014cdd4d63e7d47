#include "ui/view3d/feature_highlight.h"

#include <QtTest>

#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkNew.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

#include "tests/support/mesh_generators.h"
#include "tests/support/qt/qt_suite.h"
#include "ui/widgets/theme.h"

using namespace nearfit;

class FeatureHighlightTest : public QObject {
  Q_OBJECT

 private slots:
  void cleanup() { ui::setColourScheme(ui::ColourScheme::Light); }
  void itIsLighterThanTheAccentInTheDarkTheme();
};

void FeatureHighlightTest::itIsLighterThanTheAccentInTheDarkTheme() {
  const TriangleMesh mesh = test::boxMesh(glm::dvec3(1.0));
  const vtkNew<vtkRenderer> renderer;
  ui::FeatureHighlight highlight(*renderer.Get(), ui::colours::kAccent);
  PickedFeature picked;
  picked.triangles = {0};
  for (const bool isDark : {false, true}) {
    // The tool is older than the theme.
    ui::setColourScheme(isDark ? ui::ColourScheme::Dark : ui::ColourScheme::Light);
    highlight.show(mesh, picked, {});
    vtkActorCollection* actors = renderer->GetActors();
    QCOMPARE(actors->GetNumberOfItems(), 3);
    actors->InitTraversal();
    while (vtkActor* actor = actors->GetNextActor()) {
      double rgb[3];
      actor->GetProperty()->GetColor(rgb);
      const double lightness = QColor::fromRgbF(rgb[0], rgb[1], rgb[2]).lightnessF();
      QVERIFY(isDark ? lightness > ui::colours::kAccent.lightnessF() + 0.1
                     : lightness < ui::colours::kAccent.lightnessF() + 0.01);
    }
  }
}

NEARFIT_QT_SUITE(FeatureHighlightTest, test::runQtTest<FeatureHighlightTest>)
#include "feature_highlight_test.moc"
