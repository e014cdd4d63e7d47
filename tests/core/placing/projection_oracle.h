#pragma once

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/placing/view_projection.h"

/// Projection by the matrices of OpenGL, which the program's shares no code with.
namespace nearfit::test {

inline constexpr double kViewWidth = 900.0, kViewHeight = 600.0;

struct TestView {
  ViewProjection::Camera camera;

  ViewProjection projection() const { return {camera, {kViewWidth, kViewHeight}}; }

  glm::dvec2 pixelOf(const glm::dvec3& point) const {
    const double aspect = kViewWidth / kViewHeight, half = camera.halfHeight;
    const glm::dmat4 lens = camera.isParallel
                                ? glm::ortho(-half * aspect, half * aspect, -half, half, -100.0, 100.0)
                                : glm::perspective(camera.viewAngle, aspect, 1e-3, 1e3);
    const glm::dmat4 look = glm::lookAt(camera.eye, camera.eye + camera.away, camera.up);
    const glm::dvec4 clip = lens * look * glm::dvec4(point, 1.0);
    return {0.5 * kViewWidth * (1.0 + clip.x / clip.w), 0.5 * kViewHeight * (1.0 - clip.y / clip.w)};
  }
};

/// From aslant above, a bit beside the origin.
inline TestView aslant(bool isParallel = false) {
  TestView view;
  view.camera.eye = {0.7, -0.9, 0.6};
  view.camera.away = glm::dvec3(0.02, 0.03, 0.01) - view.camera.eye;
  view.camera.up = {0.0, 0.0, 1.0};
  view.camera.viewAngle = 0.42;
  view.camera.isParallel = isParallel;
  view.camera.halfHeight = 0.27;
  return view;
}

/// Along a direction at the origin, from 1 m away.
inline TestView along(const glm::dvec3& away, const glm::dvec3& up = {0.0, 0.0, 1.0},
                      bool isParallel = false) {
  TestView view = aslant(isParallel);
  view.camera.away = glm::normalize(away);
  view.camera.eye = -view.camera.away;
  view.camera.up = up;
  return view;
}

}  // namespace nearfit::test
