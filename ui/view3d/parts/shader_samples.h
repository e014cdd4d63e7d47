#pragma once

#include <memory>
#include <vector>

#include <vtkNew.h>
#include <vtkProp.h>
#include <vtkRenderer.h>

#include "ui/view3d/parts/part_actor.h"

namespace nearfit::ui {

/// Small parts of each kind that is drawn in its own way: one opaque, one seen through, with their edges. Drawing them
/// compiles the shaders of all parts in their own colours, which software OpenGL takes some 100 ms for. They are in no
/// renderer that anybody sees.
class ShaderSamples {
 public:
  ShaderSamples();

  /// Returns the actors of the next sample; empty once there are no more.
  std::vector<vtkProp*> next();
  bool isDone() const noexcept { return given_ == parts_.size(); }

 private:
  vtkNew<vtkRenderer> nowhere_;
  std::vector<std::unique_ptr<PartActor>> parts_;
  std::size_t given_ = 0;
};

}  // namespace nearfit::ui
