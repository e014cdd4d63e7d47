#pragma once

#include <array>
#include <memory>

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkTexture.h>

#include "core/scene/part.h"
#include "core/section/mesh_section.h"

namespace nearfit::ui {

/// Stripes for cut faces: one for all parts.
vtkSmartPointer<vtkTexture> makeHatch();

/// Where one part is cut open: its cut face in the part's colour, hatched, with its outline. In the renderer
/// from construction to destruction.
class PartCap {
 public:
  /// @param renderer  Outlives this.
  /// @param lean      Which way the stripes lean, as neighbours lean differently: any number.
  PartCap(vtkRenderer& renderer, vtkTexture* hatch, unsigned lean);
  ~PartCap();
  PartCap(const PartCap&) = delete;
  PartCap& operator=(const PartCap&) = delete;

  /// Cuts anew where something of it has changed.
  /// @param plane    In the world.
  /// @param spacing  Of the stripes [m].
  void show(const PartGeometryPtr& geometry, const RigidTransform& worldFromPart, const CutPlane& plane,
            double spacing);
  /// As the part looks now.
  /// @param edges  Whose look the outline shares.
  void setLook(const double colour[3], double opacity, vtkProperty* edges);

  vtkActor* face() const noexcept { return face_; }
  /// In the part's frame.
  const std::shared_ptr<const MeshSection>& section() const noexcept { return section_; }

 private:
  void fill(const std::array<glm::dvec3, 2>& stripes, double spacing);

  vtkRenderer& renderer_;
  unsigned lean_;
  vtkNew<vtkPolyData> faces_, lines_;
  vtkNew<vtkActor> face_, outline_;
  vtkNew<vtkMatrix4x4> pose_;
  PartGeometryPtr geometry_;
  CutPlane plane_;  ///< In the part's frame.
  double spacing_ = 0.0;
  std::shared_ptr<const MeshSection> section_;
};

}  // namespace nearfit::ui
