#include "ui/view3d/feature_highlight.h"

#include <unordered_map>

#include <vtkCellArray.h>
#include <vtkMapper.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include "ui/view3d/vtk/pixel_sizes.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Half the length of a drawn axis, as a fraction of the mesh's diagonal.
constexpr double kAxisLength = 0.6;

/// Collects vertices of a mesh as VTK points, each once.
class Points {
 public:
  explicit Points(const TriangleMesh& mesh) : mesh_(mesh) { points_->SetDataTypeToDouble(); }

  vtkIdType of(std::uint32_t vertex) {
    const auto [entry, isNew] = ids_.try_emplace(vertex, 0);
    if (isNew) entry->second = add(mesh_.vertices()[vertex]);
    return entry->second;
  }
  vtkIdType add(const glm::dvec3& p) { return points_->InsertNextPoint(p.x, p.y, p.z); }
  vtkPoints* get() { return points_; }

 private:
  const TriangleMesh& mesh_;
  vtkNew<vtkPoints> points_;
  std::unordered_map<std::uint32_t, vtkIdType> ids_;
};

void fillFaces(vtkPolyData& data, const TriangleMesh& mesh, const PickedFeature& picked) {
  Points points(mesh);
  vtkNew<vtkCellArray> cells;
  for (const std::uint32_t t : picked.triangles) {
    const Triangle& c = mesh.triangles()[t];
    const vtkIdType corners[3] = {points.of(c[0]), points.of(c[1]), points.of(c[2])};
    cells->InsertNextCell(3, corners);
  }
  data.Initialize();
  data.SetPoints(points.get());
  data.SetPolys(cells);
}

void fillLines(vtkPolyData& data, const TriangleMesh& mesh, const PickedFeature& picked) {
  Points points(mesh);
  vtkNew<vtkCellArray> cells;
  for (std::size_t i = 1; i < picked.vertices.size(); ++i) {
    const vtkIdType ends[2] = {points.of(picked.vertices[i - 1]), points.of(picked.vertices[i])};
    cells->InsertNextCell(2, ends);
  }
  const AlignFeature& feature = picked.feature;
  const bool hasAxis = feature.shape == FeatureShape::Axis || feature.shape == FeatureShape::Circle;
  if (hasAxis && feature.radius > 0.0) {
    const glm::dvec3 reach = kAxisLength * mesh.bounds().diagonal() * feature.direction;
    const vtkIdType ends[2] = {points.add(feature.point - reach), points.add(feature.point + reach)};
    cells->InsertNextCell(2, ends);
  }
  data.Initialize();
  data.SetPoints(points.get());
  data.SetLines(cells);
}

void fillPoint(vtkPolyData& data, const TriangleMesh& mesh, const PickedFeature& picked) {
  Points points(mesh);
  vtkNew<vtkCellArray> cells;
  // The edge of a cut face is no edge of the mesh; show one of its points instead.
  const bool isOfNoMesh = picked.triangles.empty() && picked.vertices.empty();
  const FeatureShape shape = picked.feature.shape;
  if (isOfNoMesh || shape == FeatureShape::Point || shape == FeatureShape::Circle) {
    const vtkIdType point = points.add(picked.feature.point);
    cells->InsertNextCell(1, &point);
  }
  data.Initialize();
  data.SetPoints(points.get());
  data.SetVerts(cells);
}

}  // namespace

FeatureHighlight::FeatureHighlight(vtkRenderer& renderer, const QColor& colour)
    : actors_(renderer, {.faceOpacity = 0.5, .lineWidth = 3.5F, .pointSize = 11.0F}), colour_(colour) {
  // Push the face back by more than its depth changes across lines and dots in it, so that
  // these show in full width.
  constexpr double kBehindLines = 8.0, kDeeper = 100.0;
  vtkMapper& face = *actors_.face().GetMapper();
  face.SetResolveCoincidentTopologyToPolygonOffset();
  face.SetRelativeCoincidentTopologyPolygonOffsetParameters(
      kBehindLines * static_cast<double>(devicePixels(1.0F)), kDeeper);
}

void FeatureHighlight::show(const TriangleMesh& mesh, const PickedFeature& picked,
                            const RigidTransform& worldFromPart) {
  const QColor face = themed(colour_);
  // Lines stand out from the face and, where there is none, from the ground.
  actors_.setColours(face, isThemeDark() ? face.lighter(125) : face.darker(125));
  fillFaces(actors_.faces(), mesh, picked);
  fillLines(actors_.lines(), mesh, picked);
  fillPoint(actors_.points(), mesh, picked);
  actors_.showFilled();
  actors_.setPose(worldFromPart);
}

}  // namespace nearfit::ui
