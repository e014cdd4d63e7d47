#pragma once

#include <QObject>
#include <QString>
#include <QTimer>
#include <map>
#include <memory>
#include <vector>

#include "core/mesh/check/mesh_check.h"
#include "core/session/session.h"
#include "ui/widgets/background_task.h"

namespace nearfit::ui {

class HandState;
class SceneWork;

/// A part's findings in short, for its row in the tree.
struct FindingsBadge {
  FindingSeverity worst{};
  QString text;
  bool canBeRepaired = false;  ///< A repair mends some of them.
  bool operator==(const FindingsBadge&) const = default;
};

/// Keeps the defects of all parts' meshes. Checks each geometry once, in a thread of low priority, while nothing is
/// being loaded and no part is felt. Results stay as long as their geometry, undo included.
class PartChecks : public QObject {
  Q_OBJECT

 public:
  /// @param session, work, hand  Outlive this.
  PartChecks(Session& session, const SceneWork& work, const HandState& hand, QObject* parent = nullptr);

  /// Returns the check of a geometry; null while there is none yet, or if it failed.
  std::shared_ptr<const MeshCheck> of(const PartGeometryPtr& geometry) const;
  /// True if the check of a geometry has failed, as for want of memory.
  bool hasFailed(const PartGeometryPtr& geometry) const;
  /// Checks this geometry before others.
  void prefer(const PartGeometryPtr& geometry);
  /// Returns the parts with findings that loading has not mended.
  std::map<PartId, FindingsBadge> badges() const;

 signals:
  /// Emitted some time after results have come, or parts have come or gone.
  void changed();

 private:
  struct Result {
    std::weak_ptr<const PartGeometry> geometry;
    std::shared_ptr<const MeshCheck> check;  ///< Null: it failed.
  };
  const Result* resultOf(const PartGeometryPtr& geometry) const;
  void followScene();
  void followWork();
  void start();
  /// Geometries to check next: some small ones, or a large one.
  std::vector<PartGeometryPtr> nextOnes() const;

  Session& session_;
  const SceneWork& work_;
  const HandState& hand_;
  BackgroundTask task_;
  QTimer late_;  ///< Gathers results, of which thousands of small parts bring many.
  std::map<const PartGeometry*, Result> results_;
  std::weak_ptr<const PartGeometry> preferred_;
  Subscription changes_;
};

/// Words for people.
QString nameOf(FindingKind kind);
QString nameOf(FindingSeverity severity);
/// Count of a finding with what is counted: "12 edges".
QString countText(const MeshFinding& finding);

}  // namespace nearfit::ui
