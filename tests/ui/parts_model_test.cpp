#include "ui/parts_model.h"

#include <QAbstractItemModelTester>
#include <QSignalSpy>
#include <QtTest>

#include "tests/support/mesh_generators.h"

using namespace nearfit;

namespace {

Part cube(std::string name) {
  TriangleMesh mesh = test::boxMesh(glm::dvec3(0.02));
  Part part;
  part.name = std::move(name);
  part.geometry = std::make_shared<PartGeometry>(PartGeometry{"", "", 1.0, std::move(mesh), {}, {}});
  return part;
}

}  // namespace

class PartsModelTest : public QObject {
  Q_OBJECT

 private slots:
  void keepsTheRulesOfItemModels();
  void changeOfAPartKeepsTheRows();
  void editingAsksForARenameAndChangesNothing();
};

void PartsModelTest::keepsTheRulesOfItemModels() {
  ui::PartsModel model;
  const QAbstractItemModelTester tester(&model, QAbstractItemModelTester::FailureReportingMode::QtTest);
  Scene scene;
  const PartId first = scene.add(cube("a"));
  model.setScene(scene);
  scene.add(cube("b"));
  model.setScene(scene);
  QCOMPARE(model.rowCount(), 2);
  scene.remove(first);
  model.setScene(scene);
  QCOMPARE(model.rowCount(), 1);
  QVERIFY(!model.indexOf(first).isValid());
}

void PartsModelTest::changeOfAPartKeepsTheRows() {
  ui::PartsModel model;
  Scene scene;
  const PartId id = scene.add(cube("a"));
  model.setScene(scene);
  const QSignalSpy resets(&model, &QAbstractItemModel::modelReset);
  const QPersistentModelIndex index = model.indexOf(id);
  Part renamed = *scene.find(id);
  renamed.name = std::string("b");
  scene.replace(renamed);
  model.setScene(scene);
  QCOMPARE(resets.count(), 0);
  QCOMPARE(index.data().toString(), QStringLiteral("b"));
}

void PartsModelTest::editingAsksForARenameAndChangesNothing() {
  ui::PartsModel model;
  Scene scene;
  const PartId id = scene.add(cube("a"));
  model.setScene(scene);
  QString asked;
  connect(&model, &ui::PartsModel::renameRequested, this, [&](PartId part, const QString& name) {
    QVERIFY(part == id);
    asked = name;
  });
  QVERIFY(model.setData(model.indexOf(id), QStringLiteral(" shaft "), Qt::EditRole));
  QCOMPARE(asked, QStringLiteral("shaft"));
  QCOMPARE(model.indexOf(id).data().toString(), QStringLiteral("a"));
}

QTEST_MAIN(PartsModelTest)
#include "parts_model_test.moc"
