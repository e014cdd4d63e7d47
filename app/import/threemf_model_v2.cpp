// lib3mf 2.
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <lib3mf_implicit.hpp>

#include "app/import/threemf_model.h"
#include "core/base/error.h"
#include "core/text/utf8.h"

namespace nearfit::importer {
namespace {

class Library {
 public:
  explicit Library(const ImportJob& job) : job_(job) {}

  ThreeMfModel load() {
    const Lib3MF::PWrapper wrapper = Lib3MF::CWrapper::loadLibrary();
    model_ = wrapper->CreateModel();
    const Lib3MF::PReader reader = model_->QueryReader("3mf");
    const auto* bytes = reinterpret_cast<const Lib3MF_uint8*>(job_.bytes.data());
    reader->ReadFromBuffer(Lib3MF::CInputVector<Lib3MF_uint8>(bytes, job_.bytes.size()));
    if (const std::optional<double> metres = threeMfUnit(static_cast<std::uint32_t>(model_->GetUnit())))
      result_.metresPerUnit = *metres;
    for (const Lib3MF::PBuildItemIterator items = model_->GetBuildItems(); items->MoveNext();) {
      const Lib3MF::PBuildItem item = items->GetCurrent();
      ThreeMfPlacement placement;
      if (item->HasObjectTransform()) placement = placed(item->GetObjectTransform());
      placement.object = takeObject(item->GetObjectResource());
      result_.items.push_back(placement);
    }
    return std::move(result_);
  }

 private:
  /// The format multiplies rows: its fourth one is the translation.
  static ThreeMfPlacement placed(const Lib3MF::sTransform& transform) {
    ThreeMfPlacement placement;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k)
        placement.map[i][k] = static_cast<double>(transform.m_Fields[i][k]);
      placement.translation[i] = static_cast<double>(transform.m_Fields[3][i]);
    }
    return placement;
  }

  std::uint32_t takeObject(const Lib3MF::PObject& object) {
    const std::uint32_t id = object->GetUniqueResourceID();
    const auto [at, isNew] = result_.objects.try_emplace(id);
    if (!isNew) return id;
    // References into a map stay where they are when others are added.
    ThreeMfObject& taken = at->second;
    taken.name = object->GetName();
    if (object->IsMeshObject()) {
      const Lib3MF::PMeshObject mesh = model_->GetMeshObjectByID(id);
      takeMesh(*mesh, taken);
      takeColours(*mesh, taken);
      taken.colour = colourOf(*mesh);
    }
    if (object->IsComponentsObject()) takeComponents(*model_->GetComponentsObjectByID(id), taken);
    return id;
  }

  std::optional<CadColour> colourOf(Lib3MF::CMeshObject& mesh) {
    Lib3MF_uint32 group = 0, property = 0;
    return mesh.GetObjectLevelProperty(group, property) ? colourOf(group, property) : std::nullopt;
  }

  /// Materials or colours; both null for a group of another kind.
  struct ColourGroup {
    Lib3MF::PBaseMaterialGroup materials;
    Lib3MF::PColorGroup colours;
  };

  /// A group of another kind is an error to the library, and takes long: each is asked for once.
  const ColourGroup& groupOf(Lib3MF_uint32 id) {
    const auto [at, isNew] = groups_.try_emplace(id);
    if (!isNew) return at->second;
    try {
      at->second.materials = model_->GetBaseMaterialGroupByID(id);
    } catch (const Lib3MF::ELib3MFException&) {
      at->second.materials = nullptr;
    }
    if (at->second.materials != nullptr) return at->second;
    try {
      at->second.colours = model_->GetColorGroupByID(id);
    } catch (const Lib3MF::ELib3MFException&) {
      at->second.colours = nullptr;
    }
    return at->second;
  }

  /// A colour is no reason to refuse a file: one that cannot be read is none.
  std::optional<CadColour> colourOf(Lib3MF_uint32 group, Lib3MF_uint32 property) {
    const auto [at, isNew] = colours_.try_emplace({group, property});
    if (!isNew) return at->second;
    const ColourGroup& of = groupOf(group);
    if (of.materials == nullptr && of.colours == nullptr) return std::nullopt;
    try {
      const Lib3MF::sColor colour =
          of.materials != nullptr ? of.materials->GetDisplayColor(property) : of.colours->GetColor(property);
      at->second = threeMfColour(colour.m_Red, colour.m_Green, colour.m_Blue);
    } catch (const Lib3MF::ELib3MFException&) {
      at->second = std::nullopt;
    }
    return at->second;
  }

  /// Takes the colours of triangles; of one whose corners have several, that of the first corner.
  void takeColours(Lib3MF::CMeshObject& mesh, ThreeMfObject& taken) {
    std::vector<Lib3MF::sTriangleProperties> properties;
    try {
      mesh.GetAllTriangleProperties(properties);
    } catch (const Lib3MF::ELib3MFException&) {
      return;
    }
    if (properties.size() != taken.triangles.size()) return;
    for (const Lib3MF::sTriangleProperties& of : properties)
      taken.triangleColours.add(of.m_ResourceID == 0 ? std::nullopt
                                                     : colourOf(of.m_ResourceID, of.m_PropertyIDs[0]));
  }

  static void takeMesh(Lib3MF::CMeshObject& mesh, ThreeMfObject& taken) {
    std::vector<Lib3MF::sPosition> points;
    std::vector<Lib3MF::sTriangle> corners;
    mesh.GetVertices(points);
    mesh.GetTriangleIndices(corners);
    for (const Lib3MF::sPosition& p : points)
      taken.vertices.emplace_back(p.m_Coordinates[0], p.m_Coordinates[1], p.m_Coordinates[2]);
    for (const Lib3MF::sTriangle& t : corners)
      taken.triangles.push_back({t.m_Indices[0], t.m_Indices[1], t.m_Indices[2]});
  }

  void takeComponents(Lib3MF::CComponentsObject& components, ThreeMfObject& taken) {
    for (Lib3MF_uint32 i = 0; i < components.GetComponentCount(); ++i) {
      const Lib3MF::PComponent component = components.GetComponent(i);
      ThreeMfPlacement placement;
      if (component->HasTransform()) placement = placed(component->GetTransform());
      placement.object = takeObject(component->GetObjectResource());
      taken.components.push_back(placement);
    }
  }

  const ImportJob& job_;
  Lib3MF::PModel model_;
  std::map<Lib3MF_uint32, ColourGroup> groups_;
  std::map<std::pair<Lib3MF_uint32, Lib3MF_uint32>, std::optional<CadColour>> colours_;
  ThreeMfModel result_;
};

}  // namespace

ThreeMfModel loadThreeMf(const ImportJob& job) {
  try {
    return Library(job).load();
  } catch (const Lib3MF::ELib3MFException& error) {
    throw FileError(job.file.string(), fmt::format("lib3mf cannot read it ({})", printableText(error.what())),
                    "it may be damaged: export it again, or in another format");
  }
}

}  // namespace nearfit::importer
