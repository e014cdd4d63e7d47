#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <vtkActor.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include "core/scene/scene.h"
#include "ui/view3d/parts/coloured_surface.h"
#include "ui/view3d/parts/part_shape.h"

namespace nearfit::ui {

/// The mappers of a shape: one set of GPU buffers, shared by all parts that show it. For one OpenGL context.
class ShapeMappers {
 public:
  using Mapper = vtkSmartPointer<vtkPolyDataMapper>;

  /// @param cut  Clipping plane in the world: only what lies on the side of its normal is drawn. Null: whole.
  explicit ShapeMappers(std::shared_ptr<const PartShape> shape, vtkPlane* cut = nullptr)
      : shape_(std::move(shape)), cut_(cut) {}

  /// Returns the mappers of one level: the surface's pieces, or the one draft. Opaque and translucent drawing
  /// use separate mappers, as VTK rebuilds a mapper that alternates between them.
  const std::vector<Mapper>& surface(std::size_t level, bool isTranslucent);
  /// Returns mappers of the mesh in the colours of its faces; only for a shape that has such colours.
  /// @param own  Of faces that have no colour.
  std::vector<Mapper> faces(bool isTranslucent, const Colour& own);
  Mapper edges(bool isTranslucent);
  /// For drawing the veil without lighting, over everything else.
  Mapper veil();
  Mapper veilEdges();

  const std::shared_ptr<const PartShape>& shape() const noexcept { return shape_; }
  bool isCut() const noexcept { return cut_ != nullptr; }
  /// True if a part has been drawn by the mappers of this level: drawing another by them uploads nothing.
  bool isUploaded(std::size_t level, bool isTranslucent) const {
    return uploaded_.contains({level, isTranslucent});
  }
  void setUploaded(std::size_t level, bool isTranslucent) { uploaded_.emplace(level, isTranslucent); }
  /// Makes a mapper for a surface, clipped as the shape's own are.
  Mapper surfaceMapperOf(vtkPolyData* data) const;

 private:
  Mapper mapperOf(vtkPolyData* data) const;
  Mapper& made(Mapper& mapper, vtkPolyData* data) const;

  std::shared_ptr<const PartShape> shape_;
  vtkSmartPointer<vtkPlane> cut_;
  std::array<std::vector<std::vector<Mapper>>, 2> surfaces_;  ///< Opaque, translucent; by level.
  /// Opaque, translucent; by the part's own colour.
  std::array<std::map<std::array<float, 3>, std::vector<Mapper>>, 2> faces_;
  std::array<Mapper, 2> edges_;
  Mapper veil_, veilEdges_;
  std::set<std::pair<std::size_t, bool>> uploaded_;  ///< Level; true: translucent.
};

/// Shares one set of mappers for each shape and clipping plane, as long as someone holds it.
class MapperCache {
 public:
  std::shared_ptr<ShapeMappers> mappersOf(const std::shared_ptr<const PartShape>& shape,
                                          vtkPlane* cut = nullptr);

 private:
  static constexpr std::size_t kFewEntries = 64;
  void dropUnused();

  std::map<std::pair<const PartShape*, const vtkPlane*>, std::weak_ptr<ShapeMappers>> entries_;
  std::size_t nextDrop_ = kFewEntries;  ///< Number of entries at which those that nobody holds are dropped.
};

/// How a part is drawn, apart from its own colour.
struct PartLook {
  bool isMoving = false;
  bool isSelected = false;
  bool isHighlighted = false;  ///< Shows through others as a selected part does, but is not selected.
  bool isTranslucent = false;
  bool isOverlapping = false;  ///< Overlaps the moving part, which therefore cannot feel it.
  bool hasEdges = true;
  /// Others are drawn in the colours of their clearances, this one is not: it must not tint them.
  bool isBesideColours = false;
  bool isDark = false;   ///< The theme, on whose background edges stand out.
  double opacity = 1.0;  ///< The part's own opacity, 0 to 1.
  bool operator==(const PartLook&) const = default;
};

/// The actors of one part: surface and edge lines. In the renderer from construction to destruction.
/// While the part is selected or highlighted, a faint veil and its edges are also drawn over everything, so that it
/// shows behind other parts. Beside parts in the colours of their clearances, a translucent part is little more than its
/// edges, which stand out from the background, and there is no veil. If it has such colours itself, edges and what is
/// within the range are drawn, the latter opaque: its own outer wall would hide the colours of a bore.
class PartActor {
 public:
  /// @param renderer  Outlives this.
  /// @param over      Draws the veil over everything; outlives this. Null: no veil.
  PartActor(vtkRenderer& renderer, std::shared_ptr<ShapeMappers> mappers, vtkRenderer* over = nullptr);
  ~PartActor();
  PartActor(const PartActor&) = delete;
  PartActor& operator=(const PartActor&) = delete;

  /// Moves the part; true if that changed its pose.
  bool setPose(const RigidTransform& worldFromPart);
  /// True if the appearance changed.
  bool setAppearance(const Colour& colour, bool isVisible, const PartLook& look);
  /// Sets the scale at which it is seen; hides edge lines, the veil's too, where they would cover the part.
  void setScale(double pixelsPerMetre);
  /// Draws one of the shape's levels. Edge lines are drawn with level 0, the mesh itself, only.
  void setLevel(std::size_t level);
  /// Exchanges the mappers: cut open or whole, of the same shape.
  void setMappers(std::shared_ptr<ShapeMappers> mappers);
  /// Draws the mesh in the colours of its clearances; null: in the part's own. Drafts stay in the part's own.
  /// @param isStale  See setClearanceColours().
  /// @return  True if that changed anything.
  bool setColours(std::shared_ptr<const ColouredSurface> colours, bool isStale);
  /// Hides the part while a kept picture shows it (CachingRenderer).
  void setKept(bool isKept);
  /// Leaves a part that no picture has shown yet out of pictures until admit().
  void holdBack();
  /// From now on pictures show the part at any level.
  void admit();

  const PartShape& shape() const noexcept { return *mappers_->shape(); }
  const ShapeMappers& mappers() const noexcept { return *mappers_; }
  bool isVisible() const noexcept { return isVisible_; }
  bool isOpaque() const noexcept;
  /// True if what is behind it is seen.
  bool isSeenThrough() const noexcept { return !isOpaque() || showsOnlyNear(); }
  /// True if of its mesh only what is within the range of clearances is drawn.
  bool showsOnlyNear() const noexcept;
  std::size_t level() const noexcept { return level_; }
  /// Levels of detail as they are drawn.
  std::span<const DetailLevel> levels() const noexcept { return levels_; }
  /// Null if it is drawn in its own colour.
  const std::shared_ptr<const ColouredSurface>& colours() const noexcept { return colours_; }
  /// The last argument of setColours().
  bool areColoursStale() const noexcept { return areColoursStale_; }
  bool isKept() const noexcept { return isKept_; }
  /// True until admit(): no picture shows it, or none has yet.
  bool isNew() const noexcept { return isNew_; }
  bool isHeldBack() const noexcept { return isHeldBack_; }
  /// True if drawing it at its present level uploads nothing.
  bool isUploaded() const { return mappers_->isUploaded(level_, !isOpaque()); }
  /// Gets the bounds of the mesh itself in the world, VTK's order [m].
  void bounds(double bounds[6]) const;
  /// Appends the actors that draw the visible part, piece by piece.
  void addTo(std::vector<vtkProp*>& props) const;
  /// Returns the actors that draw the part at its present level, visible or not.
  std::vector<vtkProp*> drawnProps() const;
  /// Actors of the surface's pieces.
  const std::vector<vtkSmartPointer<vtkActor>>& pieces() const noexcept { return pieces_; }
  /// Shared by all pieces.
  vtkProperty& look() const noexcept { return *look_.Get(); }
  vtkProperty& edgeLook() const noexcept { return *edges_->GetProperty(); }

 private:
  void addPiece();
  /// Removes actors that only a coloured surface needs.
  void dropExtraPieces();
  void showPieces();
  const std::vector<ShapeMappers::Mapper>& surfaceMappers();
  const std::vector<ShapeMappers::Mapper>& clearanceMappers();
  void applyColours();
  /// True if it would tint or hide colours behind it, and must not.
  bool isOutlined() const noexcept;
  bool hasEdges() const noexcept;
  double opacity() const noexcept;
  void hideBackFaces();
  /// Sets what depends on the look, level and colours.
  void applyLook();
  void setThrough(bool isThrough);
  void showVeil();

  vtkRenderer& renderer_;
  std::shared_ptr<ShapeMappers> mappers_;
  vtkRenderer* over_;
  std::vector<vtkSmartPointer<vtkActor>> pieces_;  ///< The first one also draws drafts.
  vtkNew<vtkProperty> look_;
  vtkNew<vtkActor> edges_;
  /// In over_ while selected or highlighted; else null.
  vtkSmartPointer<vtkActor> veil_, veilEdges_;
  vtkNew<vtkMatrix4x4> pose_;
  std::optional<RigidTransform> worldFromPart_;
  std::optional<PartLook> shownLook_;
  Colour colour_;
  std::shared_ptr<const ColouredSurface> colours_;
  vtkNew<vtkLookupTable> table_;                                    ///< Colours of clearances.
  std::array<std::vector<ShapeMappers::Mapper>, 2> colourMappers_;  ///< All; within the range.
  std::vector<ShapeMappers::Mapper> faceMappers_;                   ///< In use.
  std::vector<DetailLevel> levels_;
  bool areColoursStale_ = false;
  std::size_t level_ = 0;
  std::size_t drawnPieces_ = 0;  ///< Number of pieces_ at this level.
  bool isVisible_ = true, isKept_ = false;
  bool isNew_ = true, isHeldBack_ = false;
  bool areEdgesApart_ = true;  ///< At the present scale edge lines do not cover the part.
};

}  // namespace nearfit::ui
