#include "ui/view3d/parts/shader_samples.h"

namespace nearfit::ui {
namespace {

constexpr double kSeenThroughSample = 0.5;  ///< Any opacity below 1 is drawn alike.

/// Every edge is sharp, so that lines are drawn too.
TriangleMesh tetrahedron() {
  return {{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}},
          {Triangle{0, 2, 1}, Triangle{0, 1, 3}, Triangle{0, 3, 2}, Triangle{1, 2, 3}}};
}

}  // namespace

ShaderSamples::ShaderSamples() {
  const auto shape = std::make_shared<const PartShape>(makePartShape(tetrahedron()));
  const auto mappers = std::make_shared<ShapeMappers>(shape);
  for (const double opacity : {1.0, kSeenThroughSample}) {
    auto part = std::make_unique<PartActor>(*nowhere_.Get(), mappers);
    PartLook look;
    look.opacity = opacity;
    part->setPose({});
    part->setAppearance({}, true, look);
    parts_.push_back(std::move(part));
  }
}

std::vector<vtkProp*> ShaderSamples::next() {
  return isDone() ? std::vector<vtkProp*>{} : parts_[given_++]->drawnProps();
}

}  // namespace nearfit::ui
