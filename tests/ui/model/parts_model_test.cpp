#include "ui/model/parts_model.h"

#include <QAbstractItemModelTester>
#include <QMimeData>
#include <QSignalSpy>
#include <QtTest>

#include "tests/support/mesh_generators.h"
#include "tests/support/qt/qt_suite.h"

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
  void groupsStandBeforePartsAndHoldTheirs();
  void whatIsDroppedAsksForItsPlaceAndChangesNothing();
  void jointsAreShownBesideTheirPart();
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

void PartsModelTest::groupsStandBeforePartsAndHoldTheirs() {
  ui::PartsModel model;
  const QAbstractItemModelTester tester(&model, QAbstractItemModelTester::FailureReportingMode::QtTest);
  Scene scene;
  const PartId free = scene.add(cube("free"));
  const GroupId outer = scene.addGroup({{}, "outer", {}, false});
  const GroupId inner = scene.addGroup({{}, "inner", outer, false});
  Part part = cube("in");
  part.group = inner;
  const PartId in = scene.add(part);
  model.setScene(scene);
  QCOMPARE(model.rowCount(), 2);
  QVERIFY(model.groupAt(model.index(0, 0)) == outer && model.partAt(model.index(1, 0)) == free);
  QVERIFY(model.indexOf(in).parent() == model.indexOf(inner));
  QVERIFY(model.indexOf(inner).parent() == model.indexOf(outer));
  QCOMPARE(model.indexOf(in).data().toString(), QStringLiteral("in"));
  QCOMPARE(model.indexOf(outer).data(Qt::AccessibleTextRole).toString(), QStringLiteral("Group outer"));
  part = *scene.find(in);
  part.group.reset();
  scene.replace(part);
  model.setScene(scene);
  QVERIFY(!model.indexOf(in).parent().isValid());
}

void PartsModelTest::whatIsDroppedAsksForItsPlaceAndChangesNothing() {
  ui::PartsModel model;
  Scene scene;
  const PartId part = scene.add(cube("a"));
  const GroupId group = scene.addGroup({{}, "g", {}, false}), other = scene.addGroup({{}, "h", {}, false});
  model.setScene(scene);
  SceneNodes asked;
  std::optional<GroupId> where;
  connect(&model, &ui::PartsModel::regroupRequested, this,
          [&](const SceneNodes& nodes, std::optional<GroupId> target) { asked = nodes, where = target; });
  const std::unique_ptr<QMimeData> data(
      model.mimeData({model.indexOf(part), model.indexOf(part).siblingAtColumn(1), model.indexOf(other)}));
  QVERIFY(!model.dropMimeData(data.get(), Qt::MoveAction, -1, -1, model.indexOf(group)));
  QVERIFY(asked == (SceneNodes{{part}, {other}}) && where == group);
  model.dropMimeData(data.get(), Qt::MoveAction, 0, 0, {});
  QVERIFY(!where);
  QCOMPARE(model.rowCount(), 3);
  // What another program drags means nothing here.
  asked = {};
  QMimeData foreign;
  foreign.setData(model.mimeTypes().front(), QByteArray(13, '\1'));
  model.dropMimeData(&foreign, Qt::MoveAction, -1, -1, model.indexOf(group));
  foreign.setData(model.mimeTypes().front(), {});
  model.dropMimeData(&foreign, Qt::MoveAction, -1, -1, model.indexOf(group));
  QVERIFY(asked.isEmpty());
}

void PartsModelTest::jointsAreShownBesideTheirPart() {
  ui::PartsModel model;
  Scene scene;
  const PartId base = scene.add(cube("base")), kept = scene.add(cube("kept"));
  Joint joint;
  joint.part = kept;
  joint.base = base;
  const JointId id = scene.addJoint(joint);
  model.setScene(scene);
  const auto cell = [&](PartId part, int role) {
    return model.indexOf(part).siblingAtColumn(ui::PartsModel::Joints).data(role);
  };
  QVERIFY(cell(base, Qt::DecorationRole).value<QIcon>().isNull());
  QVERIFY(!cell(kept, Qt::DecorationRole).value<QIcon>().isNull());
  QVERIFY(cell(kept, Qt::ToolTipRole).toString().startsWith(QStringLiteral("Kept on axis of base\n")));
  joint = *scene.findJoint(id);
  joint.isOn = false;
  scene.replaceJoint(joint);
  const QSignalSpy resets(&model, &QAbstractItemModel::modelReset);
  model.setScene(scene);
  QCOMPARE(resets.count(), 0);
  QVERIFY(cell(kept, Qt::ToolTipRole).toString().startsWith(QStringLiteral("Kept on axis of base (off)\n")));
}

NEARFIT_QT_SUITE(PartsModelTest, test::runQtTest<PartsModelTest>)
#include "parts_model_test.moc"
