#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace nearfit {

/// A ray of sight in the world.
struct ViewRay {
  glm::dvec3 origin{0.0};                ///< [m]
  glm::dvec3 direction{0.0, 0.0, -1.0};  ///< Unit, away from the viewer.
};

/// How a view shows the world: a camera over a rectangle of pixels. A pixel's position counts from the upper
/// left corner of the view, x to the right and y down, and need not be whole.
class ViewProjection {
 public:
  struct Camera {
    glm::dvec3 eye{0.0, 0.0, 1.0};    ///< In parallel projection any point that is seen in the middle [m].
    glm::dvec3 away{0.0, 0.0, -1.0};  ///< Direction of sight; of any length but zero.
    glm::dvec3 up{0.0, 1.0, 0.0};     ///< What is seen upright; need not be square to `away`.
    bool isParallel = false;
    double viewAngle = 0.4;   ///< Of the view's height, in perspective [rad].
    double halfHeight = 1.0;  ///< Of the view, in parallel projection [m].
  };

  ViewProjection() : ViewProjection(Camera{}, {1.0, 1.0}) {}
  /// @param size  Of the view [pixels]; what is not positive counts as one.
  ViewProjection(const Camera& camera, const glm::dvec2& size);

  /// Unit and square to each other, in the world; `right` and `up` are the screen's.
  const glm::dvec3& right() const noexcept { return right_; }
  const glm::dvec3& up() const noexcept { return up_; }
  const glm::dvec3& away() const noexcept { return away_; }
  bool isParallel() const noexcept { return camera_.isParallel; }
  /// The pixel in the middle of the view.
  glm::dvec2 middle() const noexcept { return 0.5 * size_; }

  /// How far in front of the eye, along the direction of sight [m].
  double depthOf(const glm::dvec3& point) const noexcept;
  /// The direction in which a point is seen; unit, in the world. In parallel projection that of sight.
  glm::dvec3 sightOf(const glm::dvec3& point) const noexcept;
  /// Nothing for what is not in front of the eye. Points beside the view have pixels too.
  std::optional<glm::dvec2> pixelOf(const glm::dvec3& point) const noexcept;
  ViewRay rayThrough(const glm::dvec2& pixel) const noexcept;
  /// Of a length across the direction of sight at the depth of a point [m]; 0 where it is not in front of the
  /// eye.
  double metresPerPixel(const glm::dvec3& point) const noexcept;

 private:
  Camera camera_;
  glm::dvec2 size_;
  glm::dvec3 right_, up_, away_;
  double slope_;  ///< Half the view's height at depth 1, in perspective.
};

}  // namespace nearfit
