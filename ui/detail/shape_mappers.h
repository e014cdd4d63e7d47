#pragma once

#include <array>
#include <memory>
#include <vector>

#include <vtkPolyDataMapper.h>
#include <vtkSmartPointer.h>

#include "ui/part_shape.h"

namespace nearfit::ui {

/// What the graphics card holds of a shape: one set of buffers, however many parts show it. One OpenGL
/// context.
class ShapeMappers {
 public:
  using Mapper = vtkSmartPointer<vtkPolyDataMapper>;

  explicit ShapeMappers(std::shared_ptr<const PartShape> shape) : shape_(std::move(shape)) {}

  /// Of a level of the shape: its pieces, or the one draft. VTK builds a mapper anew whenever what is opaque
  /// and what is not take turns on it, so each has its own.
  const std::vector<Mapper>& surface(std::size_t level, bool isTranslucent);
  Mapper edges(bool isTranslucent);
  /// Without light, over everything else.
  Mapper veil();
  Mapper veilEdges();

  const std::shared_ptr<const PartShape>& shape() const noexcept { return shape_; }

 private:
  std::shared_ptr<const PartShape> shape_;
  std::array<std::vector<std::vector<Mapper>>, 2> surfaces_;  ///< Opaque or translucent, then by level.
  std::array<Mapper, 2> edges_;
  Mapper veil_, veilEdges_;
};

/// One set for each shape while anyone holds it.
class MapperCache {
 public:
  std::shared_ptr<ShapeMappers> mappersOf(const std::shared_ptr<const PartShape>& shape);

 private:
  std::map<const PartShape*, std::weak_ptr<ShapeMappers>> entries_;
};

}  // namespace nearfit::ui
