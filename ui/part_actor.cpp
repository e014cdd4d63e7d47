#include "ui/part_actor.h"

#include <utility>

#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "ui/theme.h"
#include "ui/vtk_convert.h"

namespace nearfit::ui {
namespace {

constexpr double kTranslucentOpacity = 0.28, kWarningOpacity = 0.45;
/// Faint enough that what lies before a selected part keeps its shape and colour.
constexpr double kVeilOpacity = 0.13, kVeilEdgeOpacity = 0.55;

void setEdgeColour(vtkProperty& property, const PartLook& look) {
  const QColor dark(0x1a, 0x22, 0x2b);
  const QColor colour = look.isSelected      ? colours::kAccent
                        : look.isMoving      ? colours::kMoving.darker(150)
                        : look.isOverlapping ? colours::kOverlap.darker(150)
                                             : dark;
  property.SetColor(colour.redF(), colour.greenF(), colour.blueF());
  property.SetLineWidth(look.isSelected ? 2.4F : 1.3F);
  property.SetOpacity(look.isTranslucent && !look.isSelected ? 0.55 : 1.0);
}

}  // namespace

PartActor::PartActor(vtkRenderer& renderer, std::shared_ptr<const PartShape> shape, vtkRenderer* over)
    : renderer_(renderer), shape_(std::move(shape)), over_(over) {
  vtkNew<vtkPolyDataMapper> surfaceMapper;
  surfaceMapper->SetInputData(shape_->surface);
  surfaceMapper->ScalarVisibilityOff();
  // Surfaces step back a little, so that edge lines and the shapes they bound do not fight for the same
  // depth.
  surfaceMapper->SetResolveCoincidentTopologyToPolygonOffset();
  surfaceMapper->SetRelativeCoincidentTopologyPolygonOffsetParameters(1.0, 1.0);
  surface_->SetMapper(surfaceMapper);
  surface_->SetUserMatrix(pose_);
  vtkProperty* property = surface_->GetProperty();
  property->SetInterpolationToPhong();
  property->SetAmbient(0.12);
  property->SetDiffuse(0.82);
  property->SetSpecular(0.22);
  property->SetSpecularPower(28.0);

  vtkNew<vtkPolyDataMapper> edgeMapper;
  edgeMapper->SetInputData(shape_->edges);
  edgeMapper->ScalarVisibilityOff();
  edges_->SetMapper(edgeMapper);
  edges_->SetUserMatrix(pose_);
  edges_->PickableOff();
  edges_->GetProperty()->LightingOff();

  renderer_.AddActor(surface_);
  renderer_.AddActor(edges_);
}

PartActor::~PartActor() {
  setThrough(false);
  renderer_.RemoveActor(surface_);
  renderer_.RemoveActor(edges_);
}

void PartActor::setPose(const RigidTransform& worldFromPart) {
  setMatrix(*pose_, worldFromPart);
}

void PartActor::setAppearance(const Colour& colour, bool isVisible, const PartLook& look) {
  surface_->SetVisibility(isVisible);
  edges_->SetVisibility(isVisible && look.hasEdges);
  vtkProperty* property = surface_->GetProperty();
  if (look.isOverlapping) {
    property->SetColor(colours::kOverlap.redF(), colours::kOverlap.greenF(), colours::kOverlap.blueF());
  } else {
    property->SetColor(static_cast<double>(colour.r), static_cast<double>(colour.g),
                       static_cast<double>(colour.b));
  }
  property->SetOpacity(look.opacity * (!look.isTranslucent  ? 1.0
                                       : look.isOverlapping ? kWarningOpacity
                                                            : kTranslucentOpacity));
  setEdgeColour(*edges_->GetProperty(), look);
  setThrough(isVisible && look.isSelected);
}

void PartActor::setThrough(bool isThrough) {
  if (over_ == nullptr || isThrough == (veil_ != nullptr)) return;
  if (!isThrough) {
    over_->RemoveActor(veil_);
    over_->RemoveActor(veilEdges_);
    veil_ = veilEdges_ = nullptr;
    return;
  }
  const auto make = [this](vtkPolyData* data, double opacity) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(data);
    mapper->ScalarVisibilityOff();
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    actor->SetUserMatrix(pose_);
    actor->PickableOff();
    vtkProperty* property = actor->GetProperty();
    property->LightingOff();
    property->SetColor(colours::kAccent.redF(), colours::kAccent.greenF(), colours::kAccent.blueF());
    property->SetOpacity(opacity);
    over_->AddActor(actor);
    return actor;
  };
  veil_ = make(shape_->surface, kVeilOpacity);
  // One layer of a closed surface, not two.
  veil_->GetProperty()->BackfaceCullingOn();
  veilEdges_ = make(shape_->edges, kVeilEdgeOpacity);
  veilEdges_->GetProperty()->SetLineWidth(1.6F);
}

vtkStaticCellLocator* PartActor::locator() {
  if (locator_ == nullptr) {
    locator_ = vtkSmartPointer<vtkStaticCellLocator>::New();
    locator_->SetDataSet(shape_->surface);
    locator_->BuildLocator();
  }
  return locator_;
}

}  // namespace nearfit::ui
