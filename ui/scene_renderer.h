#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "core/placing/seen_parts.h"
#include "core/scene/scene.h"
#include "ui/detail/detail_choice.h"
#include "ui/part_actor.h"
#include "ui/section/scene_cut.h"

namespace nearfit::ui {

/// What is seen at a place of the view.
struct PickedPoint {
  PartId part{};
  glm::dvec3 point{0.0};       ///< Of its surface, in the world [m].
  std::uint32_t triangle = 0;  ///< Of its mesh; 0 on a cut face.
  /// Of the part's cut face, in the part's frame; null where its own surface is seen.
  std::shared_ptr<const MeshSection> cut;
};

/// Keeps one actor for each part of the scene that is shown. Knows no widget and renders nothing itself.
class SceneRenderer {
 public:
  /// @param renderer  Outlives this.
  /// @param over      Drawn over it, outlives this: what is selected shows through there; may be null.
  SceneRenderer(vtkRenderer& renderer, std::shared_ptr<PartShapeCache> shapes, vtkRenderer* over = nullptr);

  void setScene(const Scene& scene);
  void setSelected(std::vector<PartId> parts);
  /// While there is a moving part, all others become see-through, so that what lies between can be seen.
  void setSeeThrough(bool isSeeThrough);
  void setEdgesVisible(bool isVisible);
  /// Shows the part away from its pose in the scene, where the hand has it; nothing puts it back.
  void setPoseInHand(std::optional<RigidTransform> worldFromMoving);

  /// Shows parts away from their poses in the scene, where a drag has them; empty: none.
  void setDragged(std::map<PartId, RigidTransform> worldFromPart);

  /// Where a part is shown, by a drag, by the hand or as the scene has it.
  RigidTransform shownPose(const Part& part) const;

  /// Cuts the parts open; nothing: they are whole.
  void setCut(const std::optional<ViewCut>& cut);
  /// The cut follows the parts: before each picture.
  void updateCut();
  /// What cuts the moving part now, for what goes with it: see SceneCut::plane. Null: it is whole.
  vtkPlane* cutOfMoving() const noexcept { return cut_.cuts(true) ? cut_.plane() : nullptr; }
  /// Parts that are cut and cannot be closed, as of the last picture.
  const std::vector<PartId>& openlyCut() const noexcept { return cut_.open(); }

  /// Parts that the moving one overlaps are tinted.
  void setOverlapping(std::span<const PartId> parts);

  /// What is drawn in the next picture: parts that are kept are not. @return  The choice for the others.
  DetailChoice applyDetail(const DetailLimits& limits);
  /// What draws the opaque parts that are seen and do not move, as they are. They get no levels of detail and
  /// are not drawn until letGoOfKept().
  std::vector<vtkProp*> keep();
  /// As they are, whatever the last picture showed of them; before each time that some are drawn to be kept.
  void prepareKept();
  void showKept();
  void letGoOfKept();
  /// Another one: what is kept is no longer right.
  std::uint64_t revision() const noexcept { return revision_; }
  /// Parts that have been moved since the last time that all stood still; the others can be kept.
  /// Null when it is not in the scene.
  const PartActor* find(PartId part) const;
  bool hasLoose() const noexcept { return !loose_.empty(); }
  /// Whether parts that are seen shine through.
  bool hasTranslucent() const;
  void settle();

  /// Bounds of all visible parts as VTK has them (xmin, xmax, ...) [m]; false when there are none.
  bool visibleBounds(double bounds[6]) const;
  /// Of one part, visible or not; false when it is not in the scene.
  bool boundsOf(PartId part, double bounds[6]) const;
  /// The part under a point of the view, in display coordinates from the lower left.
  std::optional<PartId> pick(double x, double y) {
    const std::optional<PickedPoint> picked = pickPoint(x, y);
    return picked ? std::optional(picked->part) : std::nullopt;
  }
  /// As pick, with the point of its surface.
  std::optional<PickedPoint> pickPoint(double x, double y);
  /// Of which something is seen at the pixels of a box, in the scene's order: what shines through hides
  /// nothing.
  std::vector<PartId> seenIn(const ViewProjection& view, const PixelBox& pixels) const;

 private:
  struct View;
  PartActor& actorOf(const Part& part);
  void applyAppearance(const Part& part);
  void applyAll();
  void place(const Part& part);
  void open(PartActor& actor, bool isCut);
  View view() const;
  /// The part whose cut face has a point of the plane.
  std::optional<PickedPoint> capAt(const glm::dvec3& point) const;

  vtkRenderer& renderer_;
  std::shared_ptr<PartShapeCache> shapes_;
  vtkRenderer* over_;
  MapperCache mappers_;
  Scene scene_;
  std::map<PartId, std::unique_ptr<PartActor>> actors_;
  std::vector<PartId> selected_;  ///< Sorted.
  std::optional<RigidTransform> poseInHand_;
  std::map<PartId, RigidTransform> dragged_;
  std::vector<PartId> overlapping_;
  SceneCut cut_;
  bool isSeeThrough_ = false;
  bool hasEdges_ = true;
  std::set<PartId> loose_;
  std::vector<PartActor*> beingKept_;
  std::uint64_t revision_ = 0;
};

}  // namespace nearfit::ui
