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

/// Makes the stripes for cut faces; one texture serves all parts.
vtkSmartPointer<vtkTexture> makeHatch();

/// The cut face of one part: in the part's colour, hatched, with its outline. In the renderer from
/// construction to destruction.
class PartCap {
 public:
  /// @param renderer  Outlives this.
  /// @param lean      Selects the angle of the stripes; any number. Neighbours should differ.
  PartCap(vtkRenderer& renderer, vtkTexture* hatch, unsigned lean);
  ~PartCap();
  PartCap(const PartCap&) = delete;
  PartCap& operator=(const PartCap&) = delete;

  /// Computes the section, unless nothing has changed.
  /// @param plane    World frame.
  /// @param spacing  Distance of the stripes [m].
  void show(const PartGeometryPtr& geometry, const RigidTransform& worldFromPart, const CutPlane& plane,
            double spacing);
  /// Makes the cut face look like the part.
  /// @param colour  RGB, 0 to 1.
  /// @param edges   The part's edge property; the outline shares it.
  void setLook(const double colour[3], double opacity, vtkProperty* edges);

  vtkActor* face() const noexcept { return face_; }
  /// The section in the part's frame; null before show().
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
