#include "ui/view3d/glyphs/hand_ghost.h"

#include <utility>

#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "ui/model/hand_lead.h"
#include "ui/view3d/vtk/pixel_sizes.h"
#include "ui/view3d/vtk/vtk_convert.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr double kOpacity = 0.1, kEdgeOpacity = 0.9;
/// Below this fraction of the part's size the ghost is hidden: two almost equal outlines would flicker.
constexpr double kMinLead = 0.003;

void setUp(vtkActor& actor, const QColor& colour, float lineWidth) {
  actor.PickableOff();
  vtkProperty* property = actor.GetProperty();
  property->SetColor(colour.redF(), colour.greenF(), colour.blueF());
  property->SetLineWidth(devicePixels(lineWidth));
}

void setInput(vtkActor& actor, vtkPolyData* data) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->ScalarVisibilityOff();
  actor.SetMapper(mapper);
}

}  // namespace

HandGhost::HandGhost(vtkRenderer& parts, vtkRenderer& overlay) {
  setUp(*surface_, colours::kHand, 1.0F);
  setUp(*edges_, colours::kHand, 2.2F);
  setUp(*line_, colours::kHand, 3.0F);
  setOpacity(1.0);
  line_->GetProperty()->VertexVisibilityOn();
  line_->GetProperty()->SetVertexColor(colours::kHand.redF(), colours::kHand.greenF(),
                                       colours::kHand.blueF());
  line_->GetProperty()->SetPointSize(devicePixels(9.0F));
  for (vtkActor* actor : {edges_.Get(), line_.Get()})
    actor->GetProperty()->LightingOff();
  for (vtkActor* actor : {surface_.Get(), edges_.Get()}) {
    actor->SetUserMatrix(pose_);
    parts.AddActor(actor);
  }
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(lead_->GetOutputPort());
  line_->SetMapper(mapper);
  overlay.AddActor(line_);
  applyVisibility();
}

void HandGhost::setShape(std::shared_ptr<const PartShape> shape) {
  if (shape == shape_) return;
  shape_ = std::move(shape);
  if (shape_ != nullptr) {
    setInput(*surface_, shape_->finestDraft());
    setInput(*edges_, shape_->edges);
    applyCut();
  }
  applyVisibility();
}

void HandGhost::show(const ServoSnapshot& snapshot, double size) {
  const HandLead lead = handLeadOf(snapshot);
  isAhead_ = lead.distance + 0.5 * size * lead.angle > kMinLead * size;
  if (isAhead_) {
    setMatrix(*pose_, snapshot.handle);
    lead_->SetPoint1(lead.handCentre.x, lead.handCentre.y, lead.handCentre.z);
    lead_->SetPoint2(snapshot.centre.x, snapshot.centre.y, snapshot.centre.z);
  }
  applyVisibility();
}

void HandGhost::clear() {
  isAhead_ = false;
  applyVisibility();
}

void HandGhost::setVisible(bool isVisible) {
  isVisible_ = isVisible;
  applyVisibility();
}

void HandGhost::setOpacity(double share) {
  surface_->GetProperty()->SetOpacity(kOpacity * share);
  edges_->GetProperty()->SetOpacity(kEdgeOpacity * share);
  line_->GetProperty()->SetOpacity(share);
}

void HandGhost::setCut(vtkPlane* cut) {
  if (cut == cut_) return;
  cut_ = cut;
  applyCut();
}

void HandGhost::applyCut() {
  for (vtkActor* actor : {surface_.Get(), edges_.Get()}) {
    vtkMapper* mapper = actor->GetMapper();
    if (mapper == nullptr) continue;
    mapper->RemoveAllClippingPlanes();
    if (cut_ != nullptr) mapper->AddClippingPlane(cut_);
  }
}

bool HandGhost::visibleBounds(double bounds[6]) const {
  if (surface_->GetVisibility() == 0) return false;
  surface_->GetBounds(bounds);
  return true;
}

void HandGhost::applyVisibility() {
  for (vtkActor* actor : {surface_.Get(), edges_.Get(), line_.Get()})
    actor->SetVisibility(isVisible_ && isAhead_ && shape_ != nullptr);
}

}  // namespace nearfit::ui
