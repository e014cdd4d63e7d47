#pragma once

#include <glm/vec3.hpp>
#include <vtkMatrix4x4.h>

#include "core/math/rigid_transform.h"
#include "core/scene/scene.h"

namespace nearfit::ui {

/// Writes a pose into a VTK matrix (row-major, acts on column vectors). Marks it modified only if it changed.
inline void setMatrix(vtkMatrix4x4& matrix, const RigidTransform& pose) {
  const glm::dmat4 m = pose.toMatrix();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column)
      matrix.SetElement(row, column, m[column][row]);
  }
}

}  // namespace nearfit::ui
