// lib3mf 1, whose interface is one of C: objects are pointers to be released, and each call returns an error code.
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Model/COM/NMR_DLLInterfaces.h>
#include <fmt/format.h>

#include "app/import/threemf_model.h"
#include "core/base/error.h"
#include "core/text/utf8.h"

namespace nearfit::importer {
namespace {

struct Release {
  void operator()(NMR::PLib3MFBase* object) const { NMR::lib3mf_release(object); }
};
using Owned = std::unique_ptr<NMR::PLib3MFBase, Release>;

/// Longest name that is asked for [bytes].
constexpr std::size_t kMaxThreeMfName = 4096;

class Library {
 public:
  explicit Library(const ImportJob& job) : job_(job) {}

  /// @param on  The object that was called, which knows more of the error; may be null.
  void check(LIB3MFRESULT result, NMR::PLib3MFBase* on = nullptr) const {
    if (result == 0) return;
    DWORD code = 0;
    const char* text = nullptr;
    if (on != nullptr) NMR::lib3mf_getlasterror(on, &code, &text);
    throw FileError(job_.file.string(),
                    fmt::format("lib3mf cannot read it ({})",
                                text == nullptr ? fmt::format("error {:#x}", static_cast<unsigned>(result))
                                                : printableText(text)),
                    "it may be damaged: export it again, or in another format");
  }

  ThreeMfModel load() {
    NMR::PLib3MFBase* model = nullptr;
    check(NMR::lib3mf_createmodel(&model));
    const Owned ownedModel(model);
    model_ = model;
    NMR::PLib3MFBase* reader = nullptr;
    check(NMR::lib3mf_model_queryreader(model, "3mf", &reader), model);
    const Owned ownedReader(reader);
    // It takes bytes that it does not change.
    auto* bytes = reinterpret_cast<BYTE*>(const_cast<char*>(job_.bytes.data()));
    check(NMR::lib3mf_reader_readfrombuffer(reader, bytes, job_.bytes.size()), reader);
    DWORD unit = 0;
    check(NMR::lib3mf_model_getunit(model, &unit), model);
    if (const std::optional<double> metres = threeMfUnit(unit)) result_.metresPerUnit = *metres;
    takeItems(model);
    return std::move(result_);
  }

 private:
  static ThreeMfPlacement placed(DWORD object, const NMR::MODELTRANSFORM& transform) {
    ThreeMfPlacement placement;
    placement.object = object;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        placement.map[column][row] = static_cast<double>(transform.m_fFields[row][column]);
      placement.translation[row] = static_cast<double>(transform.m_fFields[row][3]);
    }
    return placement;
  }

  void takeItems(NMR::PLib3MFBase* model) {
    NMR::PLib3MFBase* items = nullptr;
    check(NMR::lib3mf_model_getbuilditems(model, &items), model);
    const Owned ownedItems(items);
    for (;;) {
      BOOL hasNext = 0;
      check(NMR::lib3mf_builditemiterator_movenext(items, &hasNext), items);
      if (hasNext == 0) return;
      NMR::PLib3MFBase* item = nullptr;
      check(NMR::lib3mf_builditemiterator_getcurrent(items, &item), items);
      const Owned ownedItem(item);
      NMR::PLib3MFBase* object = nullptr;
      check(NMR::lib3mf_builditem_getobjectresource(item, &object), item);
      const Owned ownedObject(object);
      NMR::MODELTRANSFORM transform{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
      BOOL hasTransform = 0;
      check(NMR::lib3mf_builditem_hasobjecttransform(item, &hasTransform), item);
      if (hasTransform != 0) check(NMR::lib3mf_builditem_getobjecttransform(item, &transform), item);
      result_.items.push_back(placed(takeObject(object), transform));
    }
  }

  /// Takes an object and those that it is made of; returns its id.
  DWORD takeObject(NMR::PLib3MFBase* object) {
    DWORD id = 0;
    check(NMR::lib3mf_resource_getresourceid(object, &id), object);
    const auto [at, isNew] = result_.objects.try_emplace(id);
    if (!isNew) return id;
    // References into a map stay where they are when others are added.
    ThreeMfObject& taken = at->second;
    taken.name = nameOf(object);
    taken.colour = colourOf(object);
    BOOL isMesh = 0, isComponents = 0;
    check(NMR::lib3mf_object_ismeshobject(object, &isMesh), object);
    check(NMR::lib3mf_object_iscomponentsobject(object, &isComponents), object);
    if (isMesh != 0) takeMesh(object, taken);
    if (isComponents != 0) takeComponents(object, taken);
    return id;
  }

  std::string nameOf(NMR::PLib3MFBase* object) const {
    std::vector<char> buffer(kMaxThreeMfName);
    ULONG needed = 0;
    if (NMR::lib3mf_object_getnameutf8(object, buffer.data(), static_cast<ULONG>(buffer.size()), &needed) !=
        0)
      return {};
    buffer.back() = '\0';
    return buffer.data();
  }

  /// A colour is no reason to refuse a file: one that cannot be read is none.
  std::optional<CadColour> colourOf(NMR::PLib3MFBase* object) const {
    NMR::PLib3MFBase* properties = nullptr;
    if (NMR::lib3mf_object_createdefaultpropertyhandler(object, &properties) != 0) return std::nullopt;
    const Owned ownedProperties(properties);
    NMR::eModelPropertyType type = NMR::MODELPROPERTYTYPE_NONE;
    if (NMR::lib3mf_defaultpropertyhandler_getpropertytype(properties, &type) != 0) return std::nullopt;
    if (type == NMR::MODELPROPERTYTYPE_BASEMATERIALS) {
      DWORD group = 0, index = 0;
      if (NMR::lib3mf_defaultpropertyhandler_getbasematerial(properties, &group, &index) != 0)
        return std::nullopt;
      return colourOfMaterial(group, index);
    }
    NMR::MODELMESHCOLOR_SRGB colour{};
    if (type != NMR::MODELPROPERTYTYPE_COLOR ||
        NMR::lib3mf_defaultpropertyhandler_getcolor(properties, 0, &colour) != 0)
      return std::nullopt;
    return threeMfColour(colour.m_Red, colour.m_Green, colour.m_Blue);
  }

  std::optional<CadColour> colourOfMaterial(DWORD group, DWORD index) const {
    NMR::PLib3MFBase* materials = nullptr;
    if (NMR::lib3mf_model_getbasematerialbyid(model_, group, &materials) != 0) return std::nullopt;
    const Owned ownedMaterials(materials);
    BYTE red = 0, green = 0, blue = 0, alpha = 0;
    if (NMR::lib3mf_basematerial_getdisplaycolor(materials, index, &red, &green, &blue, &alpha) != 0)
      return std::nullopt;
    return threeMfColour(red, green, blue);
  }

  void takeMesh(NMR::PLib3MFBase* object, ThreeMfObject& taken) const {
    DWORD vertices = 0, triangles = 0;
    check(NMR::lib3mf_meshobject_getvertexcount(object, &vertices), object);
    check(NMR::lib3mf_meshobject_gettrianglecount(object, &triangles), object);
    if (vertices == 0 || triangles == 0) return;
    std::vector<NMR::MODELMESHVERTEX> points(vertices);
    std::vector<NMR::MODELMESHTRIANGLE> corners(triangles);
    check(NMR::lib3mf_meshobject_getvertices(object, points.data(), vertices, nullptr), object);
    check(NMR::lib3mf_meshobject_gettriangleindices(object, corners.data(), triangles, nullptr), object);
    for (const NMR::MODELMESHVERTEX& p : points)
      taken.vertices.emplace_back(p.m_fPosition[0], p.m_fPosition[1], p.m_fPosition[2]);
    for (const NMR::MODELMESHTRIANGLE& t : corners)
      taken.triangles.push_back({t.m_nIndices[0], t.m_nIndices[1], t.m_nIndices[2]});
    takeColours(object, taken);
  }

  /// Takes the colours of triangles; of one whose corners have several, that of the first corner.
  void takeColours(NMR::PLib3MFBase* object, ThreeMfObject& taken) const {
    NMR::PLib3MFBase* properties = nullptr;
    if (NMR::lib3mf_meshobject_createpropertyhandler(object, &properties) != 0) return;
    const Owned ownedProperties(properties);
    // The library leaves zeros where there is no colour or material.
    const std::size_t count = taken.triangles.size();
    std::vector<DWORD> groups(count), indices(count);
    std::vector<NMR::MODELMESH_TRIANGLECOLOR_SRGB> colours(count);
    if (NMR::lib3mf_propertyhandler_getbasematerialarray(properties, groups.data(), indices.data()) != 0 ||
        NMR::lib3mf_propertyhandler_getcolorarray(properties, colours.data()) != 0)
      return;
    std::map<std::pair<DWORD, DWORD>, std::optional<CadColour>> materials;
    for (std::size_t i = 0; i < count; ++i) {
      const NMR::MODELMESHCOLOR_SRGB& c = colours[i].m_Colors[0];
      if (c.m_Red != 0 || c.m_Green != 0 || c.m_Blue != 0 || c.m_Alpha != 0) {
        taken.triangleColours.add(threeMfColour(c.m_Red, c.m_Green, c.m_Blue));
      } else if (groups[i] != 0) {
        const auto [at, isNew] = materials.try_emplace({groups[i], indices[i]});
        if (isNew) at->second = colourOfMaterial(groups[i], indices[i]);
        taken.triangleColours.add(at->second);
      } else {
        taken.triangleColours.add(std::nullopt);
      }
    }
  }

  void takeComponents(NMR::PLib3MFBase* object, ThreeMfObject& taken) {
    DWORD count = 0;
    check(NMR::lib3mf_componentsobject_getcomponentcount(object, &count), object);
    for (DWORD i = 0; i < count; ++i) {
      NMR::PLib3MFBase* component = nullptr;
      check(NMR::lib3mf_componentsobject_getcomponent(object, i, &component), object);
      const Owned ownedComponent(component);
      NMR::PLib3MFBase* child = nullptr;
      check(NMR::lib3mf_component_getobjectresource(component, &child), component);
      const Owned ownedChild(child);
      NMR::MODELTRANSFORM transform{};
      check(NMR::lib3mf_component_gettransform(component, &transform), component);
      taken.components.push_back(placed(takeObject(child), transform));
    }
  }

  const ImportJob& job_;
  NMR::PLib3MFBase* model_ = nullptr;  ///< Owned by load().
  ThreeMfModel result_;
};

}  // namespace

ThreeMfModel loadThreeMf(const ImportJob& job) {
  return Library(job).load();
}

}  // namespace nearfit::importer
