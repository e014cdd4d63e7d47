#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/base/progress.h"
#include "core/math/rigid_transform.h"
#include "core/mesh/shaded_mesh.h"
#include "core/picture/raster.h"
#include "core/scene/part_geometry.h"

namespace nearfit {

/// A parallel projection of the world. `right` and `up` are unit and perpendicular, as on the picture.
struct PictureView {
  glm::dvec3 centre{0.0};  ///< Seen in the middle [m].
  glm::dvec3 right{1.0, 0.0, 0.0}, up{0.0, 0.0, 1.0};
  double extent = 1.0;  ///< Width of what is seen [m]; > 0.

  /// Away from the viewer; unit.
  glm::dvec3 away() const noexcept { return glm::cross(up, right); }
};

/// Standard directions of view, those of the window: z is up; Front looks along +y, Right along -x; Top shows x to the
/// right.
enum class PictureSide : std::uint8_t { Isometric, Front, Right, Top };

/// A view from a standard direction, as yet of nothing: see fitted().
PictureView viewFrom(PictureSide side) noexcept;
/// A view along a direction, with z up where it can be.
/// @param away  Any length but 0.
PictureView viewAlong(const glm::dvec3& away) noexcept;

/// The view moved and scaled so that a picture of that size shows these points with a rim around them. No smaller than
/// `minExtent` [m]. Without points the view stays.
PictureView fitted(const PictureView& view, std::span<const glm::dvec3> points, int width, int height,
                   double minExtent = 0.0) noexcept;

/// Corners of a mesh's box in the world [m].
std::array<glm::dvec3, 8> boxCorners(const TriangleMesh& mesh, const RigidTransform& worldFromPart) noexcept;

/// Geometries prepared for drawing, each once.
class DrawnShapes {
 public:
  /// On all processors. Throws Cancelled.
  /// @param geometries  Not null; may repeat.
  explicit DrawnShapes(std::span<const PartGeometryPtr> geometries, const ProgressCallback& progress = {});

  struct Shape {
    PartGeometryPtr geometry;
    ShadedMesh shaded;
  };
  /// The shape of one of the geometries.
  const Shape& of(const PartGeometry& geometry) const { return *shapes_.at(&geometry); }

 private:
  std::map<const PartGeometry*, std::unique_ptr<Shape>> shapes_;
};

/// A part as it is drawn.
struct DrawnPart {
  PartGeometryPtr geometry;  ///< With triangles.
  RigidTransform worldFromPart;
  Colour colour;
  Raster::Cover cover = Raster::Cover::Full;
};

/// A line through points, or a dot if there is only one; seen through what is in front of it.
struct DrawnMark {
  std::vector<glm::dvec3> points;  ///< [m]
  Colour colour;
  double width = 2.0;  ///< [pixels]
};

struct ScenePicture {
  PictureView view;
  std::vector<DrawnPart> parts;
  std::vector<DrawnMark> marks;
};

/// Draws parts with their sharp edges, lit from the viewer's upper left, and marks, on white. The brightness of a surface
/// with the unit normal n is kDarkest + (1 - kDarkest) (1 + n.l) / 2, l the direction of pictureLight().
/// @param width, height  [pixels]
Picture drawn(const ScenePicture& scene, const DrawnShapes& shapes, int width, int height);

/// Brightness of a surface that faces away from the light.
constexpr double kDarkest = 0.35;
/// Direction to the light, unit: right, up and to the viewer.
glm::dvec3 pictureLight() noexcept;

}  // namespace nearfit
