#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "core/placing/seen_parts.h"
#include "core/scene/scene.h"
#include "ui/view3d/parts/detail_choice.h"
#include "ui/view3d/parts/part_actor.h"
#include "ui/view3d/parts/scene_cut.h"

namespace nearfit::ui {

class ShownPoses;

/// The surface point seen at a pixel of the view.
struct PickedPoint {
  PartId part{};
  glm::dvec3 point{0.0};       ///< In the world [m].
  std::uint32_t triangle = 0;  ///< Index in the part's mesh; 0 on a cut face.
  /// The part's cut face, in the part's frame; null if its own surface is seen.
  std::shared_ptr<const MeshSection> cut;
};

/// How picking takes surfaces that are seen through: translucent ones that are not in the colours of their clearances.
enum class SeenThrough : std::uint8_t {
  AsOthers,  ///< The nearest surface is picked, whichever it is.
  Last,      ///< They are picked only where no other surface is, in front of them or behind.
  Never,
};

/// Max work that one picture has with parts that none has shown yet: their geometry goes to OpenGL first.
struct NewPartLimits {
  std::size_t shapes = 0;     ///< Parts of one shape upload it once. A single shape is never too much.
  std::size_t triangles = 0;  ///< Of all these shapes together, as they are drawn.
};

/// Says of a surface of which only what is within the range of clearances is drawn, whether that is so at a point in
/// the part's frame [m].
using IsNearAt = std::function<bool(PartId part, std::uint32_t triangle, const glm::dvec3& point)>;

/// Keeps one PartActor for each part of the scene. Knows no widget; never renders by itself.
class SceneRenderer {
 public:
  /// @param renderer, poses  Outlive this.
  /// @param over             Drawn over `renderer`; shows selected parts through others. Outlives this; may be
  ///                         null.
  SceneRenderer(vtkRenderer& renderer, std::shared_ptr<PartShapeCache> shapes, const ShownPoses& poses,
                vtkRenderer* over = nullptr);

  void setScene(const Scene& scene);
  /// Draws the shapes that have been made in place of what stood in for them. Returns false if there is none.
  bool takeNewShapes();
  /// Makes those that are still missing first: for a picture that must show all.
  void makeShapes();
  void setSelected(std::vector<PartId> parts);
  /// Shows parts through others without their being selected.
  void setHighlighted(std::vector<PartId> parts);
  /// While there is a moving part, makes all others translucent, so that gaps between them can be seen.
  void setSeeThrough(bool isSeeThrough);
  void setEdgesVisible(bool isVisible);
  /// Takes the colours of the present theme; call when it has changed.
  void followTheme();
  /// Moves parts to where ShownPoses has them now; ignores those that are not in the scene.
  void place(std::span<const PartId> parts);

  /// Cuts the parts open; nullopt: they are whole.
  void setCut(const std::optional<ViewCut>& cut);
  /// Makes the cut follow the parts; call before each picture.
  void updateCut();
  /// Clipping plane of the moving part, for what is drawn with it: see SceneCut::plane. Null: it is whole.
  vtkPlane* cutOfMoving() const noexcept { return cut_.cuts(true) ? cut_.plane() : nullptr; }
  /// Parts that are cut but cannot be closed, as of the last picture.
  const std::vector<PartId>& openlyCut() const noexcept { return cut_.open(); }

  /// Surfaces to be drawn in the colours of their clearances, by part.
  using Colours = std::map<PartId, std::shared_ptr<const ColouredSurface>>;
  /// Draws these parts in the colours of their clearances, and all others in their own: these do not tint the colours,
  /// see PartActor. A part whose mesh is exchanged later loses its colours.
  /// @param isStale  See setClearanceColours().
  /// @return  True if that changed anything.
  bool setColours(const Colours& colours, bool isStale);

  /// Tints the parts that the moving part overlaps.
  void setOverlapping(std::span<const PartId> parts);

  /// Chooses what the next picture draws of each part, except of parts shown by a kept picture.
  /// @param newLimits  If parts that no picture has shown yet are more than this, holds all of them back: pictures leave
  ///                   them out until admitNext(). Everything else takes them as they are. Nullopt: holds none back.
  /// @return  The choice for those drawn; parts held back have a level, but their triangles do not count.
  DetailChoice applyDetail(const DetailLimits& limits, const std::optional<NewPartLimits>& newLimits = {});
  /// True if the last applyDetail() holds parts back and admitNext() has not come to its end since.
  bool isHoldingBack() const noexcept { return !heldBack_.empty(); }
  /// Admits the part held back that is largest in the picture to the pictures that follow, and with it parts before and
  /// behind it that need no upload. Parts that have left or been hidden meanwhile are passed over.
  /// @return  The props to upload; empty if no part is held back any more.
  std::vector<vtkProp*> admitNext();
  /// Admits all parts, those that no picture has shown yet too.
  void admitAll();
  /// Chooses what a kept picture is to show, and returns its props: visible opaque parts that rest. They
  /// are drawn as usual until showKept().
  std::vector<vtkProp*> keep();
  /// Sets the chosen parts to full detail, whatever the last picture drew. Call before each turn of
  /// drawing the kept picture.
  void prepareKept();
  /// The kept picture is complete: the chosen parts are no longer drawn, until letGoOfKept().
  void showKept();
  /// Draws all parts again; there is no kept picture any more.
  void letGoOfKept();
  /// Changes whenever a kept picture becomes wrong.
  std::uint64_t revision() const noexcept { return revision_; }
  /// Returns the part's actor; null if it is not in the scene.
  const PartActor* find(PartId part) const;
  /// True if parts have moved since the last settle(); those cannot be kept.
  bool hasLoose() const noexcept { return !loose_.empty(); }
  /// True if a visible part is translucent.
  bool hasTranslucent() const;
  /// Regards all parts as resting from now on.
  void settle();

  /// Gets the bounds of all visible parts, VTK's order (xmin, xmax, ...), in the world [m];
  /// false if there are none.
  bool visibleBounds(double bounds[6]) const;
  /// Gets the bounds of one part, visible or not; false if it is not in the scene.
  bool boundsOf(PartId part, double bounds[6]) const;
  /// Returns the part seen at a point in VTK display coordinates: device pixels from the lower left.
  std::optional<PartId> pick(double x, double y) {
    const std::optional<PickedPoint> picked = pickPoint(x, y);
    return picked ? std::optional(picked->part) : std::nullopt;
  }
  /// Like pick(), with the point of its surface.
  /// @param isNearAt  Lets the pick pass what is not drawn of a part with clearances that is seen through; empty: no.
  std::optional<PickedPoint> pickPoint(double x, double y, SeenThrough seenThrough = SeenThrough::AsOthers,
                                       const IsNearAt& isNearAt = {});
  /// Returns the parts seen at some pixel of a box, in the scene's order. Translucent parts hide nothing.
  std::vector<PartId> seenIn(const ViewProjection& view, const PixelBox& pixels) const;

 private:
  struct View;
  PartActor& actorOf(const Part& part);
  void applyAppearance(const Part& part);
  void applyAll();
  void place(const Part& part);
  void open(PartActor& actor, bool isCut);
  View view() const;
  /// A part drawn by the next picture.
  struct Candidate;
  /// Admits new parts or holds them back, and takes what is held back out of the choice.
  void limitNew(std::span<const Candidate> drawn, const std::optional<NewPartLimits>& limits,
                DetailChoice& choice);
  /// True if the cut face of that part is seen through.
  bool isCapSeenThrough(PartId part) const;
  /// Returns the part whose cut face contains a point of the plane.
  std::optional<PickedPoint> capAt(const glm::dvec3& point) const;

  vtkRenderer& renderer_;
  std::shared_ptr<PartShapeCache> shapes_;
  vtkRenderer* over_;
  const ShownPoses& poses_;
  MapperCache mappers_;
  Scene scene_;
  std::map<PartId, std::unique_ptr<PartActor>> actors_;
  std::vector<PartId> selected_, highlighted_;  ///< Sorted.
  std::vector<PartId> overlapping_;
  SceneCut cut_;
  bool isSeeThrough_ = false;
  bool hasColours_ = false;  ///< Some parts are drawn in the colours of their clearances.
  bool hasEdges_ = true;
  std::set<PartId> loose_;
  std::vector<PartActor*> beingKept_;
  std::vector<PartId> heldBack_;  ///< The largest in the picture last.
  std::uint64_t revision_ = 0;
};

}  // namespace nearfit::ui
