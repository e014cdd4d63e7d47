#pragma once

#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <vtkPlane.h>
#include <vtkPolyDataMapper.h>
#include <vtkSmartPointer.h>

#include "ui/part_shape.h"

namespace nearfit::ui {

/// What the graphics card holds of a shape: one set of buffers, however many parts show it. One OpenGL
/// context.
class ShapeMappers {
 public:
  using Mapper = vtkSmartPointer<vtkPolyDataMapper>;

  /// @param cut  In the world; what lies behind it is not drawn. Null: the shape is whole.
  explicit ShapeMappers(std::shared_ptr<const PartShape> shape, vtkPlane* cut = nullptr)
      : shape_(std::move(shape)), cut_(cut) {}

  /// Of a level of the shape: its pieces, or the one draft. VTK builds a mapper anew whenever what is opaque
  /// and what is not take turns on it, so each has its own.
  const std::vector<Mapper>& surface(std::size_t level, bool isTranslucent);
  Mapper edges(bool isTranslucent);
  /// Without light, over everything else.
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
  std::array<std::vector<std::vector<Mapper>>, 2> surfaces_;  ///< Opaque or translucent, then by level.
  std::array<Mapper, 2> edges_;
  Mapper veil_, veilEdges_;
};

/// One set for each shape, and one for each plane that cuts it, while anyone holds it.
class MapperCache {
 public:
  std::shared_ptr<ShapeMappers> mappersOf(const std::shared_ptr<const PartShape>& shape,
                                          vtkPlane* cut = nullptr);

 private:
  std::map<std::pair<const PartShape*, const vtkPlane*>, std::weak_ptr<ShapeMappers>> entries_;
};

}  // namespace nearfit::ui
