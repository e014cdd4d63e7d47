#pragma once

#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <vtkPlane.h>
#include <vtkPolyDataMapper.h>
#include <vtkSmartPointer.h>

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
  Mapper edges(bool isTranslucent);
  /// For drawing the veil without lighting, over everything else.
  Mapper veil();
  Mapper veilEdges();

  const std::shared_ptr<const PartShape>& shape() const noexcept { return shape_; }
  bool isCut() const noexcept { return cut_ != nullptr; }

 private:
  Mapper mapperOf(vtkPolyData* data) const;
  Mapper surfaceMapperOf(vtkPolyData* data) const;
  Mapper& made(Mapper& mapper, vtkPolyData* data) const;

  std::shared_ptr<const PartShape> shape_;
  vtkSmartPointer<vtkPlane> cut_;
  std::array<std::vector<std::vector<Mapper>>, 2> surfaces_;  ///< Opaque, translucent; by level.
  std::array<Mapper, 2> edges_;
  Mapper veil_, veilEdges_;
};

/// Shares one set of mappers for each shape and clipping plane, as long as someone holds it.
class MapperCache {
 public:
  std::shared_ptr<ShapeMappers> mappersOf(const std::shared_ptr<const PartShape>& shape,
                                          vtkPlane* cut = nullptr);

 private:
  std::map<std::pair<const PartShape*, const vtkPlane*>, std::weak_ptr<ShapeMappers>> entries_;
};

}  // namespace nearfit::ui
