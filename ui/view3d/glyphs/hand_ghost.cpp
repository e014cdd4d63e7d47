#include "ui/view3d/glyphs/hand_ghost.h"

#include <algorithm>
#include <utility>

#include <vtkBoundingBox.h>
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

HandGhost::HandGhost(vtkRenderer& parts, vtkRenderer& overlay) : parts_(parts) {
  setUp(*line_, colours::kHand, 3.0F);
  line_->GetProperty()->VertexVisibilityOn();
  line_->GetProperty()->SetVertexColor(colours::kHand.redF(), colours::kHand.greenF(),
                                       colours::kHand.blueF());
  line_->GetProperty()->SetPointSize(devicePixels(9.0F));
  line_->GetProperty()->LightingOff();
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(lead_->GetOutputPort());
  line_->SetMapper(mapper);
  overlay.AddActor(line_);
  addCopy();
  setOpacity(1.0);
  applyVisibility();
}

void HandGhost::addCopy() {
  Copy& copy = *copies_.emplace_back(std::make_unique<Copy>());
  setUp(*copy.surface, colours::kHand, 1.0F);
  setUp(*copy.edges, colours::kHand, 2.2F);
  copy.edges->GetProperty()->LightingOff();
  for (vtkActor* actor : {copy.surface.Get(), copy.edges.Get()}) {
    actor->SetUserMatrix(copy.pose);
    parts_.AddActor(actor);
  }
}

void HandGhost::setShape(std::shared_ptr<const PartShape> shape) {
  std::vector<Piece> pieces;
  if (shape != nullptr) pieces.push_back({std::move(shape), {}});
  setPieces(std::move(pieces));
}

void HandGhost::setPieces(std::vector<Piece> pieces) {
  const bool isSame = std::ranges::equal(pieces, pieces_, {}, &Piece::shape, &Piece::shape);
  pieces_ = std::move(pieces);
  if (!isSame) {
    while (copies_.size() < pieces_.size())
      addCopy();
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      setInput(*copies_[i]->surface, pieces_[i].shape->finestDraft());
      setInput(*copies_[i]->edges, pieces_[i].shape->edges);
    }
    applyOpacity();
    applyCut();
  }
  applyVisibility();
}

void HandGhost::show(const ServoSnapshot& snapshot, double size) {
  const HandLead lead = handLeadOf(snapshot);
  isAhead_ = lead.distance + 0.5 * size * lead.angle > kMinLead * size;
  if (isAhead_) {
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      setMatrix(*copies_[i]->pose, snapshot.handle * pieces_[i].movingFromPart);
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
  opacity_ = share;
  applyOpacity();
}

void HandGhost::applyOpacity() {
  for (const std::unique_ptr<Copy>& copy : copies_) {
    copy->surface->GetProperty()->SetOpacity(kOpacity * opacity_);
    copy->edges->GetProperty()->SetOpacity(kEdgeOpacity * opacity_);
  }
  line_->GetProperty()->SetOpacity(opacity_);
}

void HandGhost::setCut(vtkPlane* cut) {
  if (cut == cut_) return;
  cut_ = cut;
  applyCut();
}

void HandGhost::applyCut() {
  for (const std::unique_ptr<Copy>& copy : copies_) {
    for (vtkActor* actor : {copy->surface.Get(), copy->edges.Get()}) {
      vtkMapper* mapper = actor->GetMapper();
      if (mapper == nullptr) continue;
      mapper->RemoveAllClippingPlanes();
      if (cut_ != nullptr) mapper->AddClippingPlane(cut_);
    }
  }
}

bool HandGhost::visibleBounds(double bounds[6]) const {
  vtkBoundingBox box;
  for (const std::unique_ptr<Copy>& copy : copies_) {
    if (copy->surface->GetVisibility() != 0) box.AddBounds(copy->surface->GetBounds());
  }
  if (box.IsValid() == 0) return false;
  box.GetBounds(bounds);
  return true;
}

void HandGhost::applyVisibility() {
  const bool isShown = isVisible_ && isAhead_ && !pieces_.empty();
  for (std::size_t i = 0; i < copies_.size(); ++i) {
    for (vtkActor* actor : {copies_[i]->surface.Get(), copies_[i]->edges.Get()})
      actor->SetVisibility(isShown && i < pieces_.size());
  }
  line_->SetVisibility(isShown);
}

}  // namespace nearfit::ui
