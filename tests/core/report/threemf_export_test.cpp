#include "core/report/threemf_export.h"

#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/core/report/assembly_fixture.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/zip_entries.h"

namespace nearfit::threemf_export_test {
namespace {

using testing::HasSubstr;

/// An element's attributes, references in them resolved.
using Attributes = std::map<std::string, std::string>;

std::string resolved(std::string text) {
  const std::pair<const char*, const char*> references[] = {
      {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&apos;", "'"}, {"&amp;", "&"}};
  for (const auto& [reference, character] : references)
    for (std::size_t at = 0; (at = text.find(reference, at)) != text.npos; ++at)
      text.replace(at, std::string(reference).size(), character);
  return text;
}

struct Placed {
  int object = 0;
  glm::dmat4 map{1.0};  ///< Of columns.
};

struct Object {
  std::string name, type, material;
  std::vector<glm::dvec3> vertices;
  std::vector<Attributes> triangles;
  std::vector<Placed> components;
};

Placed placedOf(Attributes element) {
  Placed placed;
  placed.object = std::stoi(element.at("objectid"));
  if (!element.contains("transform")) return placed;
  std::istringstream in(element.at("transform"));
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 3; ++column)
      EXPECT_TRUE(in >> placed.map[row][column]);
  return placed;
}

/// Reads the model element by element, as the specification gives it.
struct Model {
  explicit Model(const std::string& text) {
    static const std::regex kElement("<(/?)([a-z]+)([^<>]*)>"), kAttribute("([a-zA-Z0-9:]+)=\"([^\"]*)\"");
    int open = 0;
    for (std::sregex_iterator at(text.begin(), text.end(), kElement); at != std::sregex_iterator(); ++at) {
      const std::string name = (*at)[2], inner = (*at)[3];
      if ((*at)[1].length() > 0) continue;
      Attributes attributes;
      for (std::sregex_iterator a(inner.begin(), inner.end(), kAttribute); a != std::sregex_iterator(); ++a)
        attributes[(*a)[1]] = resolved((*a)[2]);
      if (name == "model") unit = attributes["unit"];
      if (name == "base") colours.push_back(attributes["displaycolor"]);
      if (name == "object") {
        open = std::stoi(attributes["id"]);
        EXPECT_FALSE(objects.contains(open));
        objects[open].name = attributes["name"];
        objects[open].type = attributes["type"];
        objects[open].material = attributes["pindex"];
      }
      if (name == "vertex")
        objects[open].vertices.emplace_back(std::stod(attributes["x"]), std::stod(attributes["y"]),
                                            std::stod(attributes["z"]));
      if (name == "triangle") objects[open].triangles.push_back(attributes);
      if (name == "component") {
        objects[open].components.push_back(placedOf(attributes));
        EXPECT_TRUE(objects.contains(objects[open].components.back().object)) << "objects come first";
      }
      if (name == "item") items.push_back(placedOf(attributes));
    }
    for (const Placed& item : items)
      place(item, glm::dmat4(1.0), "");
  }

  struct Found {
    glm::dmat4 map;
    std::string group;
    int mesh = 0;
  };
  void place(const Placed& placed, const glm::dmat4& outer, const std::string& group) {
    const Object& object = objects.at(placed.object);
    const glm::dmat4 map = outer * placed.map;
    const bool isWrapper = object.components.size() == 1 &&
                           !objects.at(object.components[0].object).vertices.empty() &&
                           object.components[0].map == glm::dmat4(1.0);
    if (object.components.empty() || isWrapper) {
      const int mesh = isWrapper ? object.components[0].object : placed.object;
      EXPECT_TRUE(parts.emplace(object.name, Found{map, group, mesh}).second);
      return;
    }
    for (const Placed& component : object.components)
      place(component, map, object.name);
  }

  std::string unit;
  std::vector<std::string> colours;
  std::map<int, Object> objects;
  std::vector<Placed> items;
  std::map<std::string, Found> parts;
};

class ThreeMfExport : public ::testing::Test {
 protected:
  Model exported(double metresPerUnit = 1e-3) {
    exportThreeMf(model_.scene, chosenParts(model_.scene, {}), metresPerUnit, file_);
    const auto entries = test::zipEntries(test::readBytes(file_));
    EXPECT_EQ(entries.size(), 3U);
    EXPECT_THAT(entries.at("[Content_Types].xml"), HasSubstr("3dmanufacturing-3dmodel+xml"));
    EXPECT_THAT(entries.at("_rels/.rels"), HasSubstr("Target=\"/3D/3dmodel.model\""));
    return Model(entries.at("3D/3dmodel.model"));
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "fit.3mf";
  test::AssemblyScene model_;
};

TEST_F(ThreeMfExport, NamesGroupsAndPosesAreReadBack) {
  const Model model = exported();
  EXPECT_EQ(model.unit, "millimeter");
  EXPECT_EQ(model.parts.size(), 5U);
  for (const Scene::PartPtr& part : chosenParts(model_.scene, {})) {
    ASSERT_TRUE(model.parts.contains(part->name)) << part->name;
    glm::dmat4 expected = test::matrixOf(part->worldFromPart);
    for (int k = 0; k < 3; ++k)
      expected[3][k] *= 1000.0;
    EXPECT_LT(test::differenceOf(model.parts.at(part->name).map, expected), 1e-9) << part->name;
  }
  EXPECT_EQ(model.parts.at("Ring").group, "Inner");
  EXPECT_EQ(model.parts.at("Third ring").group, "Outer <1>");
  EXPECT_EQ(model.parts.at(test::kHostileName).group, "");
}

TEST_F(ThreeMfExport, VerticesAreTheMeshsOwnInTheUnit) {
  for (const double unit : {1e-3, 0.0254, 1.0}) {
    const Model model = exported(unit);
    const Object& ring = model.objects.at(model.parts.at("Ring").mesh);
    const TriangleMesh& mesh = model_.scene.get(model_.firstRing).geometry->mesh;
    ASSERT_EQ(ring.vertices.size(), mesh.vertices().size());
    for (std::size_t i = 0; i < ring.vertices.size(); ++i)
      EXPECT_LT(glm::distance(ring.vertices[i] * unit, mesh.vertices()[i]), 1e-16);
    ASSERT_EQ(ring.triangles.size(), mesh.triangles().size());
    for (std::size_t i = 0; i < ring.triangles.size(); ++i)
      EXPECT_EQ(ring.triangles[i].at("v2"), std::to_string(mesh.triangles()[i][1]));
  }
}

TEST_F(ThreeMfExport, InstancesShareAMeshAndOtherColoursHaveTheirOwn) {
  const Model model = exported();
  EXPECT_EQ(model.parts.at("Ring").mesh, model.parts.at(test::kHostileName).mesh);
  EXPECT_NE(model.parts.at("Ring").mesh, model.parts.at("Third ring").mesh);
  const auto colourOf = [&](const std::string& part) {
    return model.colours.at(std::stoul(model.objects.at(model.parts.at(part).mesh).material));
  };
  EXPECT_EQ(colourOf("Ring"), "#4080BFFF");
  EXPECT_EQ(colourOf("Third ring"), "#FF000080");
}

TEST_F(ThreeMfExport, FacesHaveTheirColoursAndOpenMeshesAreSurfaces) {
  const Model model = exported();
  const Object& box = model.objects.at(model.parts.at("Box").mesh);
  EXPECT_EQ(box.type, "model");
  EXPECT_EQ(model.objects.at(model.parts.at("Square").mesh).type, "surface");
  std::map<std::string, int> count;
  for (const Attributes& triangle : box.triangles)
    ++count[triangle.contains("p1") ? model.colours.at(std::stoul(triangle.at("p1"))) : "own"];
  EXPECT_EQ(count, (std::map<std::string, int>{{"#00FF00FF", 4}, {"#0000FFFF", 2}, {"own", 6}}));
}

TEST_F(ThreeMfExport, AnUnknownUnitNothingAndCancellingKeepTheOldFile) {
  folder_.write("fit.3mf", "old");
  const auto parts = chosenParts(model_.scene, {});
  EXPECT_THROW(exportThreeMf(model_.scene, parts, 0.123, file_), UsageError);
  EXPECT_THROW(exportThreeMf(model_.scene, {}, 1e-3, file_), UsageError);
  EXPECT_THROW(exportThreeMf(model_.scene, parts, 1e-3, file_, [](double) { return false; }), Cancelled);
  EXPECT_EQ(test::readBytes(file_), "old");
}

}  // namespace
}  // namespace nearfit::threemf_export_test
