#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace nearfit {

/// A line of sight in the world frame.
struct ViewRay {
  glm::dvec3 origin{0.0};                ///< [m]
  glm::dvec3 direction{0.0, 0.0, -1.0};  ///< Unit, away from the viewer.
};

/// How a view shows the world: a camera over a rectangle of pixels. Pixel positions count from the view's
/// upper left corner, x right and y down, and may be fractional. Points and vectors are in the world frame.
class ViewProjection {
 public:
  struct Camera {
    glm::dvec3 eye{0.0, 0.0, 1.0};    ///< [m]; in parallel projection any point seen in the middle.
    glm::dvec3 away{0.0, 0.0, -1.0};  ///< Direction of sight; any length but 0.
    glm::dvec3 up{0.0, 1.0, 0.0};     ///< Upright direction; need not be perpendicular to `away`.
    bool isParallel = false;
    double viewAngle = 0.4;   ///< Vertical, in perspective [rad].
    double halfHeight = 1.0;  ///< Half the view's height, in parallel projection [m].
  };

  ViewProjection() : ViewProjection(Camera{}, {1.0, 1.0}) {}
  /// @param size  Of the view [pixels]; a component <= 0 counts as 1.
  ViewProjection(const Camera& camera, const glm::dvec2& size);

  /// Unit, mutually perpendicular, in the world frame. `right` and `up` are those of the screen.
  const glm::dvec3& right() const noexcept { return right_; }
  const glm::dvec3& up() const noexcept { return up_; }
  const glm::dvec3& away() const noexcept { return away_; }
  bool isParallel() const noexcept { return camera_.isParallel; }
  /// Centre of the view [pixels].
  glm::dvec2 middle() const noexcept { return 0.5 * size_; }

  /// Distance in front of the eye, along the direction of sight [m].
  double depthOf(const glm::dvec3& point) const noexcept;
  /// Direction in which a point is seen; unit. In parallel projection, the direction of sight.
  glm::dvec3 sightOf(const glm::dvec3& point) const noexcept;
  /// Pixel of a point, which may lie outside the view; std::nullopt if it is not in front of the eye.
  std::optional<glm::dvec2> pixelOf(const glm::dvec3& point) const noexcept;
  /// Line of sight through a pixel.
  ViewRay rayThrough(const glm::dvec2& pixel) const noexcept;
  /// Size of a pixel across the direction of sight, at the depth of a point [m]; 0 if it is not in
  /// front of the eye.
  double metresPerPixel(const glm::dvec3& point) const noexcept;

 private:
  Camera camera_;
  glm::dvec2 size_;
  glm::dvec3 right_, up_, away_;
  double slope_;  ///< Half the view's height at depth 1, in perspective.
};

}  // namespace nearfit
