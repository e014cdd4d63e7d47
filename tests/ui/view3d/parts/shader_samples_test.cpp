#include "ui/view3d/parts/shader_samples.h"

#include <QtTest>

#include <vtkActor.h>
#include <vtkMapper.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "tests/support/qt/qt_suite.h"

using namespace nearfit;

class ShaderSamplesTest : public QObject {
  Q_OBJECT

 private slots:
  void surfacesAndEdgesOfBothKindsAreGivenOnce();
};

void ShaderSamplesTest::surfacesAndEdgesOfBothKindsAreGivenOnce() {
  ui::ShaderSamples samples;
  int opaque = 0, translucent = 0, lines = 0;
  while (!samples.isDone()) {
    const std::vector<vtkProp*> props = samples.next();
    QVERIFY(!props.empty());
    for (vtkProp* prop : props) {
      auto* actor = vtkActor::SafeDownCast(prop);
      QVERIFY(actor != nullptr);
      auto* mapper = vtkPolyDataMapper::SafeDownCast(actor->GetMapper());
      QVERIFY(mapper != nullptr);
      vtkPolyData* drawn = mapper->GetInput();
      const bool isLit = actor->GetProperty()->GetLighting();
      // A tetrahedron.
      if (isLit) QCOMPARE(drawn->GetNumberOfPolys(), vtkIdType{4});
      if (!isLit) QCOMPARE(drawn->GetNumberOfLines(), vtkIdType{6});
      ++(!isLit ? lines : actor->GetProperty()->GetOpacity() < 1.0 ? translucent : opaque);
    }
  }
  QCOMPARE(opaque, 1);
  QCOMPARE(translucent, 1);
  QCOMPARE(lines, 2);
  QVERIFY(samples.next().empty());
}

NEARFIT_QT_SUITE(ShaderSamplesTest, test::runQtTest<ShaderSamplesTest>)
#include "shader_samples_test.moc"
