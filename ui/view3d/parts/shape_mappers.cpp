#include "ui/view3d/parts/shape_mappers.h"

namespace nearfit::ui {

ShapeMappers::Mapper ShapeMappers::mapperOf(vtkPolyData* data) const {
  auto mapper = Mapper::New();
  mapper->SetInputData(data);
  mapper->ScalarVisibilityOff();
  if (cut_ != nullptr) mapper->AddClippingPlane(cut_);
  return mapper;
}

ShapeMappers::Mapper ShapeMappers::surfaceMapperOf(vtkPolyData* data) const {
  auto mapper = mapperOf(data);
  // Push surfaces back a little, so that edge lines do not fight with them for the same depth.
  mapper->SetResolveCoincidentTopologyToPolygonOffset();
  mapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(1.0, 1.0);
  return mapper;
}

ShapeMappers::Mapper& ShapeMappers::made(Mapper& mapper, vtkPolyData* data) const {
  if (mapper == nullptr) mapper = mapperOf(data);
  return mapper;
}

const std::vector<ShapeMappers::Mapper>& ShapeMappers::surface(std::size_t level, bool isTranslucent) {
  auto& levels = surfaces_[isTranslucent ? 1 : 0];
  levels.resize(shape_->levels.size());
  std::vector<Mapper>& mappers = levels.at(level);
  if (!mappers.empty()) return mappers;
  if (level > 0) {
    mappers = {surfaceMapperOf(shape_->drafts[level - 1])};
  } else {
    for (vtkPolyData* piece : shape_->pieces)
      mappers.push_back(surfaceMapperOf(piece));
  }
  return mappers;
}

ShapeMappers::Mapper ShapeMappers::edges(bool isTranslucent) {
  return made(edges_[isTranslucent ? 1 : 0], shape_->edges);
}

ShapeMappers::Mapper ShapeMappers::veil() {
  return made(veil_, shape_->finestDraft());
}

ShapeMappers::Mapper ShapeMappers::veilEdges() {
  return made(veilEdges_, shape_->edges);
}

std::shared_ptr<ShapeMappers> MapperCache::mappersOf(const std::shared_ptr<const PartShape>& shape,
                                                     vtkPlane* cut) {
  std::weak_ptr<ShapeMappers>& entry = entries_[{shape.get(), cut}];
  std::shared_ptr<ShapeMappers> mappers = entry.lock();
  if (mappers == nullptr) {
    mappers = std::make_shared<ShapeMappers>(shape, cut);
    entry = mappers;
    std::erase_if(entries_, [](const auto& other) { return other.second.expired(); });
  }
  return mappers;
}

}  // namespace nearfit::ui
