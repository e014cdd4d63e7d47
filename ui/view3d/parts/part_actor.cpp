#include "ui/view3d/parts/part_actor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <vtkBoundingBox.h>
#include <vtkPropCollection.h>

#include "ui/view3d/vtk/pixel_sizes.h"
#include "ui/view3d/vtk/vtk_convert.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Colours of parts that share a shape and for which mappers are kept: more are shown at once in no assembly.
constexpr std::size_t kMaxOwnColours = 8;

constexpr double kTranslucentOpacity = 0.28, kWarningOpacity = 0.45;
/// Beside colours that are read by a legend: a wall, which is two surfaces, changes a channel by 6 % at most.
constexpr double kOutlinedOpacity = 0.03;
/// Faint enough to leave the shape and colour of parts in front visible.
constexpr double kVeilOpacity = 0.13, kVeilEdgeOpacity = 0.55;
constexpr float kPartEdgeWidth = 1.3F;
/// Share of edges on the near side, and max share of the enclosing disc that they may cover: with more, a
/// small part would be a blot.
constexpr double kSeenEdges = 0.5, kMaxInk = 0.4;

/// Least contrast of edges with the faces that they lie on: what WCAG 2.1 (1.4.11) asks of lines that have a meaning.
constexpr double kMinEdgeContrast = 3.0;
/// Share of a part's colour that a face turned to the light has, without its gloss: ambient and diffuse light.
constexpr double kLitShare = 0.94;

/// Relative luminance, as WCAG 2.1 defines it, of sRGB.
double luminanceOf(const std::array<double, 3>& rgb) {
  constexpr std::array<double, 3> kWeights = {0.2126, 0.7152, 0.0722};
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    sum += kWeights[i] * (rgb[i] <= 0.03928 ? rgb[i] / 12.92 : std::pow((rgb[i] + 0.055) / 1.055, 2.4));
  return sum;
}

std::array<double, 3> rgbOf(const QColor& colour) {
  return {colour.redF(), colour.greenF(), colour.blueF()};
}

double contrastOf(double a, double b) {
  return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05);
}

/// Colour of edges without a meaning: of a dark and a light one that which stands out from the background, if it does so
/// from the part's faces too, and else the one that does more from these. From an opaque face one of the two always does.
QColor plainEdgeColour(const Colour& part, double opacity) {
  const QColor candidates[] = {QColor(0x1a, 0x22, 0x2b), QColor(Qt::white)};
  const ViewGround ground = viewGround();
  double ofFaces[2], ofGround[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const double own = luminanceOf(rgbOf(candidates[i]));
    ofFaces[i] = ofGround[i] = std::numeric_limits<double>::infinity();
    for (const QColor& behind : {ground.lower, ground.upper}) {
      const std::array<double, 3> under = rgbOf(behind);
      const double colour[] = {double{part.r}, double{part.g}, double{part.b}};
      std::array<double, 3> face{};
      for (std::size_t k = 0; k < 3; ++k)
        face[k] = opacity * kLitShare * colour[k] + (1.0 - opacity) * under[k];
      ofFaces[i] = std::min(ofFaces[i], contrastOf(own, luminanceOf(face)));
      ofGround[i] = std::min(ofGround[i], contrastOf(own, luminanceOf(under)));
    }
  }
  const std::size_t first = ofGround[0] >= ofGround[1] ? 0 : 1;
  if (ofFaces[first] >= kMinEdgeContrast) return candidates[first];
  return candidates[ofFaces[0] >= ofFaces[1] ? 0 : 1];
}

QColor edgeColour(const PartLook& look, const Colour& part, double opacity) {
  return look.isSelected      ? colours::kAccent
         : look.isMoving      ? colours::kMoving.darker(150)
         : look.isOverlapping ? colours::kOverlap.darker(150)
                              : plainEdgeColour(part, opacity);
}

/// Colour of a part that is little more than its edges: these alone set it off from the background.
QColor outlineOf(const PartLook& look) {
  return outlineColour(look.isSelected      ? colours::kAccent
                       : look.isMoving      ? colours::kMoving
                       : look.isOverlapping ? colours::kOverlap
                                            : colours::kOutline);
}

void setEdgeColour(vtkProperty& property, const PartLook& look, const Colour& part, double opacity,
                   bool isOutlined) {
  const QColor colour = isOutlined ? outlineOf(look) : edgeColour(look, part, opacity);
  property.SetColor(colour.redF(), colour.greenF(), colour.blueF());
  property.SetLineWidth(devicePixels(look.isSelected ? 2.4F : kPartEdgeWidth));
  property.SetOpacity(look.isTranslucent && !look.isSelected && !isOutlined ? 0.55 : 1.0);
}

/// Adds a prop that the renderer does not have yet. AddViewProp() would look through all props for it: for all
/// parts together, that takes the square of their number.
void addNew(vtkRenderer& renderer, vtkProp& prop) {
  renderer.GetViewProps()->AddItem(&prop);
  prop.AddConsumer(&renderer);
}

}  // namespace

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

std::vector<ShapeMappers::Mapper> ShapeMappers::faces(bool isTranslucent, const Colour& own) {
  auto& byColour = faces_[isTranslucent ? 1 : 0];
  const std::array<float, 3> key =
      shape_->hasOwnColour ? std::array{own.r, own.g, own.b} : std::array<float, 3>{};
  if (const auto known = byColour.find(key); known != byColour.end()) return known->second;
  // Parts hold those that they draw by.
  if (byColour.size() >= kMaxOwnColours) byColour.clear();
  vtkNew<vtkLookupTable> table;
  const auto count = static_cast<vtkIdType>(shape_->faceColours.size()) + 1;
  table->SetNumberOfTableValues(count);
  // A bin around each number.
  table->SetTableRange(-0.5, static_cast<double>(count) - 0.5);
  const auto set = [&table](vtkIdType i, float r, float g, float b) {
    table->SetTableValue(i, static_cast<double>(r), static_cast<double>(g), static_cast<double>(b), 1.0);
  };
  set(0, own.r, own.g, own.b);
  for (vtkIdType i = 1; i < count; ++i) {
    const CadColour& colour = shape_->faceColours[static_cast<std::size_t>(i) - 1];
    set(i, colour[0], colour[1], colour[2]);
  }
  std::vector<Mapper>& mappers = byColour[key];
  for (vtkPolyData* piece : shape_->colouredPieces) {
    Mapper mapper = surfaceMapperOf(piece);
    mapper->ScalarVisibilityOn();
    mapper->SetScalarModeToUseCellData();
    mapper->SetLookupTable(table);
    mapper->UseLookupTableScalarRangeOn();
    mappers.push_back(std::move(mapper));
  }
  return mappers;
}

ShapeMappers::Mapper ShapeMappers::edges(bool isTranslucent) {
  return made(edges_[isTranslucent ? 1 : 0], shape_->edges);
}

ShapeMappers::Mapper ShapeMappers::veil() {
  return made(veil_, shape_->veil);
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
    dropUnused();
  }
  return mappers;
}

void MapperCache::dropUnused() {
  // Not for each new entry: that would take the square of their number.
  if (entries_.size() < nextDrop_) return;
  std::erase_if(entries_, [](const auto& entry) { return entry.second.expired(); });
  nextDrop_ = 2 * entries_.size() + kFewEntries;
}

PartActor::PartActor(vtkRenderer& renderer, std::shared_ptr<ShapeMappers> mappers, vtkRenderer* over)
    : renderer_(renderer), mappers_(std::move(mappers)), over_(over), levels_(shape().levels) {
  look_->SetInterpolationToPhong();
  look_->SetAmbient(0.12);
  look_->SetDiffuse(0.82);
  look_->SetSpecular(0.22);
  look_->SetSpecularPower(28.0);
  for (std::size_t i = 0; i < shape().pieces.size(); ++i)
    addPiece();
  edges_->SetUserMatrix(pose_);
  edges_->PickableOff();
  edges_->GetProperty()->LightingOff();
  addNew(renderer_, *edges_.Get());
  showPieces();
}

PartActor::~PartActor() {
  setThrough(false);
  for (vtkActor* piece : pieces_)
    renderer_.RemoveActor(piece);
  renderer_.RemoveActor(edges_);
}

void PartActor::addPiece() {
  auto piece = vtkSmartPointer<vtkActor>::New();
  piece->SetProperty(look_);
  piece->SetUserMatrix(pose_);
  addNew(renderer_, *piece);
  pieces_.push_back(piece);
}

bool PartActor::setPose(const RigidTransform& worldFromPart) {
  if (worldFromPart_ && *worldFromPart_ == worldFromPart) return false;
  worldFromPart_ = worldFromPart;
  setMatrix(*pose_, worldFromPart);
  return true;
}

bool PartActor::setAppearance(const Colour& colour, bool isVisible, const PartLook& look) {
  if (shownLook_ == look && isVisible_ == isVisible && colour_ == colour) return false;
  shownLook_ = look;
  isVisible_ = isVisible;
  colour_ = colour;
  applyColours();
  if (look.isOverlapping) {
    look_->SetColor(colours::kOverlap.redF(), colours::kOverlap.greenF(), colours::kOverlap.blueF());
  } else {
    look_->SetColor(static_cast<double>(colour.r), static_cast<double>(colour.g),
                    static_cast<double>(colour.b));
  }
  applyLook();
  showPieces();
  setThrough(isVisible && (look.isSelected || look.isHighlighted));
  showVeil();
  return true;
}

void PartActor::applyLook() {
  if (!shownLook_) return;
  look_->SetOpacity(opacity());
  hideBackFaces();
  setEdgeColour(*edges_->GetProperty(), *shownLook_, colour_, opacity(), isOutlined());
}

bool PartActor::showsOnlyNear() const noexcept {
  // Drafts have no colours.
  return colours_ != nullptr && level_ == 0 && isOutlined();
}

bool PartActor::isOutlined() const noexcept {
  return shownLook_ && (shownLook_->isBesideColours || colours_ != nullptr) &&
         (shownLook_->isTranslucent || shownLook_->opacity < 1.0);
}

bool PartActor::hasEdges() const noexcept {
  return shownLook_ && (shownLook_->hasEdges || isOutlined()) && areEdgesApart_;
}

double PartActor::opacity() const noexcept {
  const PartLook& look = *shownLook_;
  if (showsOnlyNear()) return 1.0;
  if (isOutlined() && colours_ == nullptr) return std::min(look.opacity, kOutlinedOpacity);
  if (!look.isTranslucent) return look.opacity;
  return look.opacity * (look.isOverlapping ? kWarningOpacity : kTranslucentOpacity);
}

void PartActor::hideBackFaces() {
  // Back faces are half of the work of a closed surface; a part cut open shows them, and a bore seen from outside.
  look_->SetBackfaceCulling(shape().hidesItsInside && isOpaque() && !mappers_->isCut() && !showsOnlyNear());
}

bool PartActor::setColours(std::shared_ptr<const ColouredSurface> colours, bool isStale) {
  if (colours_ == colours && (areColoursStale_ == isStale || colours == nullptr)) return false;
  areColoursStale_ = isStale;
  if (colours_ != colours) {
    colours_ = std::move(colours);
    colourMappers_ = {};
    levels_ = shape().levels;
    const auto lines = static_cast<std::size_t>(shape().edges->GetNumberOfLines());
    if (colours_ != nullptr) levels_.front().triangles = colours_->triangles + lines;
  }
  applyColours();
  applyLook();
  showPieces();
  if (colours_ == nullptr) dropExtraPieces();
  showVeil();
  return true;
}

void PartActor::dropExtraPieces() {
  while (pieces_.size() > shape().pieces.size()) {
    renderer_.RemoveActor(pieces_.back());
    pieces_.pop_back();
  }
}

void PartActor::applyColours() {
  if (colours_ != nullptr) setClearanceColours(*table_.Get(), colours_->range, colour_, areColoursStale_);
}

const std::vector<ShapeMappers::Mapper>& PartActor::surfaceMappers() {
  if (level_ > 0) return mappers_->surface(level_, !isOpaque());
  if (colours_ != nullptr) return clearanceMappers();
  // What the colour of an overlapping part warns of comes before its faces'.
  const bool isInOwnColour = shape().colouredPieces.empty() || (shownLook_ && shownLook_->isOverlapping);
  if (isInOwnColour) return mappers_->surface(level_, !isOpaque());
  faceMappers_ = mappers_->faces(!isOpaque(), colour_);
  return faceMappers_;
}

const std::vector<ShapeMappers::Mapper>& PartActor::clearanceMappers() {
  std::vector<ShapeMappers::Mapper>& mappers = colourMappers_[showsOnlyNear() ? 1 : 0];
  if (!mappers.empty()) return mappers;
  for (vtkPolyData* piece : showsOnlyNear() ? colours_->nearPieces : colours_->pieces) {
    ShapeMappers::Mapper mapper = mappers_->surfaceMapperOf(piece);
    mapper->ScalarVisibilityOn();
    mapper->SetScalarModeToUsePointData();
    mapper->SetLookupTable(table_);
    mapper->UseLookupTableScalarRangeOn();
    // Clearances are interpolated, not colours: lines of one colour are straight across a triangle.
    mapper->InterpolateScalarsBeforeMappingOn();
    mappers.push_back(std::move(mapper));
  }
  return mappers;
}

void PartActor::setMappers(std::shared_ptr<ShapeMappers> mappers) {
  mappers_ = std::move(mappers);
  // They are clipped otherwise.
  colourMappers_ = {};
  hideBackFaces();
  showPieces();
  if (veil_ == nullptr) return;
  veil_->SetMapper(mappers_->veil());
  veilEdges_->SetMapper(mappers_->veilEdges());
}

bool PartActor::isOpaque() const noexcept {
  return look_->GetOpacity() >= 1.0;
}

void PartActor::setScale(double pixelsPerMetre) {
  double own[6];
  shape().surface->GetBounds(own);
  const double diagonal = vtkBoundingBox(own).GetDiagonalLength();
  const double inked = kSeenEdges * shape().edgeLength * static_cast<double>(devicePixels(kPartEdgeWidth));
  const double disc = std::numbers::pi * 0.25 * diagonal * diagonal * pixelsPerMetre;
  if (std::exchange(areEdgesApart_, inked <= kMaxInk * disc) == areEdgesApart_) return;
  showPieces();
  if (veilEdges_ != nullptr) veilEdges_->SetVisibility(areEdgesApart_);
}

void PartActor::setLevel(std::size_t level) {
  if (level == level_) return;
  level_ = level;
  applyLook();
  showPieces();
}

void PartActor::setKept(bool isKept) {
  if (isKept == isKept_) return;
  isKept_ = isKept;
  showPieces();
}

void PartActor::holdBack() {
  if (!isNew_ || isHeldBack_) return;
  isHeldBack_ = true;
  showPieces();
}

void PartActor::admit() {
  if (!isNew_) return;
  isNew_ = false;
  mappers_->setUploaded(level_, !isOpaque());
  if (!std::exchange(isHeldBack_, false)) return;
  showPieces();
}

void PartActor::showPieces() {
  const bool isDrawn = isVisible_ && !isKept_ && !isHeldBack_;
  const std::vector<ShapeMappers::Mapper>& mappers = surfaceMappers();
  while (pieces_.size() < mappers.size())
    addPiece();
  drawnPieces_ = mappers.size();
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if (i < mappers.size()) pieces_[i]->SetMapper(mappers[i]);
    pieces_[i]->SetVisibility(isDrawn && i < mappers.size());
  }
  edges_->SetMapper(mappers_->edges(edges_->GetProperty()->GetOpacity() < 1.0));
  edges_->SetVisibility(isDrawn && level_ == 0 && hasEdges());
}

void PartActor::bounds(double bounds[6]) const {
  double own[6];
  mappers_->shape()->surface->GetBounds(own);
  vtkBoundingBox box;
  for (int corner = 0; corner < 8; ++corner) {
    const double p[4] = {own[corner & 1], own[2 + (corner >> 1 & 1)], own[4 + (corner >> 2 & 1)], 1.0};
    double world[4];
    pose_->MultiplyPoint(p, world);
    box.AddPoint(world);
  }
  box.GetBounds(bounds);
}

void PartActor::addTo(std::vector<vtkProp*>& props) const {
  props.insert(props.end(), pieces_.begin(), pieces_.end());
  if (hasEdges()) props.push_back(edges_);
}

std::vector<vtkProp*> PartActor::drawnProps() const {
  const auto count = static_cast<std::ptrdiff_t>(std::min(drawnPieces_, pieces_.size()));
  std::vector<vtkProp*> props(pieces_.begin(), pieces_.begin() + count);
  if (level_ == 0 && hasEdges()) props.push_back(edges_);
  return props;
}

void PartActor::setThrough(bool isThrough) {
  if (over_ == nullptr || isThrough == (veil_ != nullptr)) return;
  if (!isThrough) {
    over_->RemoveActor(veil_);
    over_->RemoveActor(veilEdges_);
    veil_ = veilEdges_ = nullptr;
    return;
  }
  const auto make = [this](vtkMapper* mapper, double opacity) {
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    actor->SetUserMatrix(pose_);
    actor->PickableOff();
    vtkProperty* property = actor->GetProperty();
    property->LightingOff();
    property->SetColor(colours::kAccent.redF(), colours::kAccent.greenF(), colours::kAccent.blueF());
    property->SetOpacity(opacity);
    addNew(*over_, *actor);
    return actor;
  };
  veil_ = make(mappers_->veil(), kVeilOpacity);
  // One layer of a closed surface, not two.
  veil_->GetProperty()->BackfaceCullingOn();
  veilEdges_ = make(mappers_->veilEdges(), kVeilEdgeOpacity);
  veilEdges_->GetProperty()->SetLineWidth(devicePixels(1.6F));
  veilEdges_->SetVisibility(areEdgesApart_);
}

void PartActor::showVeil() {
  // A tint over the colours would falsify them.
  const bool isTint = colours_ != nullptr || (shownLook_ && shownLook_->isBesideColours);
  if (veil_ != nullptr) veil_->SetVisibility(!isTint);
}

}  // namespace nearfit::ui
