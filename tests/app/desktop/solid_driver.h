#pragma once

#include <QStatusBar>
#include <cmath>

#include <glm/trigonometric.hpp>

#include "core/math/rotation_vector.h"
#include "tests/app/desktop/view_driver.h"
#include "tests/exact/pose_certifier.h"
#include "ui/model/parts_model.h"
#include "ui/model/shown_poses.h"

namespace nearfit::test {

/// Of which a scene consists.
struct Box {
  const char* name;
  glm::dvec3 size, centre;  ///< [m]
};
using Boxes = std::vector<Box>;

/// A cube of 20 mm about the origin between two plates that are 2 mm away from it, above and below.
inline Boxes channel() {
  return {{"floor", {0.08, 0.08, 0.02}, {0, 0, -0.022}},
          {"ceiling", {0.08, 0.08, 0.02}, {0, 0, 0.022}},
          {"cube", glm::dvec3(0.02), glm::dvec3(0.0)}};
}

/// Boxes whose frames are the world's, and the first steps of moving them.
struct SolidDriver : DesktopDriver, ViewDriver {
  SolidDriver(const Boxes& boxes, bool isSolid)
      : ViewDriver(static_cast<DesktopDriver&>(*this)), boxes_(boxes) {
    QStringList files;
    for (const Box& box : boxes)
      files << writeOff(folder.path() / (std::string(box.name) + ".off"), boxMesh(box.size, box.centre));
    add(files);
    [&] { QTRY_COMPARE(session().scene().parts().size(), boxes.size()); }();
    look("viewFront");
    if (action("solid")->isChecked() != isSolid) choose("solid");
    margin = session().scene().haptics().proxy.margin;
  }

  /// By clicks on rows; the last one is the current part.
  void select(std::initializer_list<const char*> names) {
    Qt::KeyboardModifiers keys = Qt::NoModifier;
    for (const char* name : names) {
      for (std::size_t i = 0; i < boxes_.size(); ++i) {
        if (QLatin1String(boxes_[i].name) != QLatin1String(name)) continue;
        const QModelIndex row =
            partsView()->model()->index(static_cast<int>(i), static_cast<int>(ui::PartsModel::Name));
        QTest::mouseClick(partsView()->viewport(), Qt::LeftButton, keys,
                          partsView()->visualRect(row).center());
      }
      keys = Qt::ControlModifier;
    }
  }
  void press(Qt::Key key, Qt::KeyboardModifiers keys = {}) {
    window().viewport().setFocus();
    pressInView(*this, key, keys);
  }
  /// Whatever is under way has come to where it stays.
  void settle(const char* name) { QTRY_VERIFY(!view().poses().isDragged(partId(name))); }
  RigidTransform pose(const char* name) { return part(name).worldFromPart; }
  bool doMeet(const char* a, const char* b) { return doMeet(a, b, pose(b)); }
  bool doMeet(const char* a, const char* b, const RigidTransform& worldFromB) {
    const PoseCertifier certifier(part(a).geometry->mesh, part(b).geometry->mesh);
    return certifier.doMeet(pose(a).inverse() * worldFromB);
  }
  bool doPlatesMeet(const RigidTransform& worldFromCube) {
    return doMeet("floor", "cube", worldFromCube) || doMeet("ceiling", "cube", worldFromCube);
  }
  /// About which axis, and how far, by the right hand [rad].
  glm::dvec3 turnOf(const char* name) { return rotationVector(pose(name).rotation); }
  std::size_t steps() { return session().historyIndex(); }
  QString told() { return window().statusBar()->currentMessage(); }

  double margin = 0.0;  ///< That solid parts keep [m].

 private:
  Boxes boxes_;
};

/// At which the cube of the channel, turned in its place, is a margin away from both plates: half of its
/// diagonal stands up by 10 mm (cos a + sin a) then.
inline double channelAngle(double margin) {
  return std::asin((0.012 - margin) / (0.01 * std::sqrt(2.0))) - glm::radians(45.0);
}

}  // namespace nearfit::test
