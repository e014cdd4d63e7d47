#pragma once

#include <QtTest>
#include <memory>

#include "core/session/session.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/qt/qt_patience.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/view3d/glyphs/pair_segment.h"
#include "ui/view3d/viewport.h"

namespace nearfit::test {

/// A view of 400 x 400 pixels from the front, of a box of 0.1 m, with a segment before it from x = -0.03 to
/// 0.03 m.
class SegmentView {
 public:
  void show() {
    Scene scene;
    scene.add(partOf(geometryOf(boxMesh(glm::dvec3(0.1))), "box"));
    session_.reset(scene);
    view.resize(400, 400);
    view.setScene(session_.scene());
    view.show();
    QVERIFY(QTest::qWaitForWindowExposed(&view));
    QTRY_VERIFY(view.pictureCount() > 0);
    view.setView(ui::StandardView::Front);
    segment_ = std::make_unique<ui::PairSegment>(view.overlay(), colour);
    segment_->show(from, to);
    view.completePicture();
  }

 private:
  Session session_;
  ui::Selection selection_{session_};
  ui::ShownPoses poses_{session_};

 public:
  const QColor colour{200, 30, 160};
  const glm::dvec3 from{-0.03, -0.06, 0.0}, to{0.03, -0.06, 0.0};
  ui::Viewport view{std::make_shared<ui::PartShapeCache>(), selection_, poses_};

 private:
  std::unique_ptr<ui::PairSegment> segment_;
};

}  // namespace nearfit::test
