// Trees, names, instances, colours, units, volumes and boxes of STEP files, against oracle.json, which make_models.py
// computed by OpenCASCADE's Python bindings. Files that lie beside the repository are left out where they do not.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/import/import_fixture.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::import_tree_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::boxOf;
using test::imported;
using test::importModel;
using test::sharedModel;
using test::TemporaryFolder;

constexpr double kMillimetre = 1e-3;

const json& oracle() {
  static const json values = [] {
    std::ifstream file(importModel("..") / "oracle.json");
    return json::parse(file);
  }();
  return values;
}

/// Files of the oracle that are here. Those in the repository are, and are enough for the tests to be able to fail.
std::map<std::string, fs::path> filesHere() {
  std::map<std::string, fs::path> files;
  for (const auto& entry : oracle().items())
    for (const fs::path& path : {importModel(entry.key()), sharedModel("public/" + entry.key())})
      if (fs::exists(path)) files.emplace(entry.key(), path);
  EXPECT_GE(files.size(), 4U);
  return files;
}

/// Each file is imported once for all tests of this file.
const std::map<std::string, CadDocument>& documents() {
  static const std::map<std::string, CadDocument> all = [] {
    std::map<std::string, CadDocument> read;
    for (const auto& [name, path] : filesHere())
      read.emplace(name, imported(path));
    return read;
  }();
  return all;
}

glm::dvec3 pointOf(const json& values) {
  return glm::dvec3(values[0].get<double>(), values[1].get<double>(), values[2].get<double>()) * kMillimetre;
}

/// Nodes that place a product: those with a shape, and groups of the solids of one product.
std::vector<std::size_t> placedProducts(const CadDocument& document) {
  std::vector<std::size_t> products;
  for (std::size_t i = 0; i < document.nodes.size(); ++i) {
    const auto isChildWithShape = [&](const CadNode& n) {
      return n.parent == static_cast<std::int32_t>(i) && n.shape >= 0;
    };
    const bool isSolidOfGroup =
        document.nodes[i].shape >= 0 && document.nodes[i].parent >= 0 &&
        document.nodes[i].name.starts_with(
            document.nodes[static_cast<std::size_t>(document.nodes[i].parent)].name + " ");
    const bool isGroupOfSolids = document.nodes[i].shape < 0 && document.nodes.size() == 3 &&
                                 std::ranges::any_of(document.nodes, isChildWithShape) &&
                                 document.nodes[i].name == "pair";
    if ((document.nodes[i].shape >= 0 && !isSolidOfGroup) || isGroupOfSolids) products.push_back(i);
  }
  return products;
}

std::vector<const CadShape*> shapesBelow(const CadDocument& document, std::size_t node) {
  std::vector<const CadShape*> shapes;
  for (std::size_t i = 0; i < document.nodes.size(); ++i) {
    const CadNode& n = document.nodes[i];
    if (n.shape >= 0 && (i == node || n.parent == static_cast<std::int32_t>(node)))
      shapes.push_back(&document.shapes[static_cast<std::size_t>(n.shape)]);
  }
  return shapes;
}

/// The name that a label and its product give a node: made-up names of instances do not count.
std::string expectedName(const json& names) {
  const auto own = names[0].get<std::string>();
  return own.starts_with("NAUO") ? names[1].get<std::string>() : own;
}

TEST(ImportTree, EachInstanceIsThereOnceAndInTheOrderOfTheFile) {
  for (const auto& [name, document] : documents())
    EXPECT_EQ(placedProducts(document).size(), oracle().at(name).size()) << name;
}

TEST(ImportTree, NamesFromTheTopDownAreThoseOfTheFile) {
  for (const auto& [name, document] : documents()) {
    const json& wanted = oracle().at(name);
    const std::vector<std::size_t> products = placedProducts(document);
    ASSERT_EQ(products.size(), wanted.size()) << name;
    for (std::size_t i = 0; i < products.size(); ++i) {
      std::vector<std::string> path, expected;
      for (auto at = static_cast<std::int32_t>(products[i]); at >= 0;
           at = document.nodes[static_cast<std::size_t>(at)].parent)
        path.insert(path.begin(), document.nodes[static_cast<std::size_t>(at)].name);
      for (const json& names : wanted[i]["path"])
        expected.push_back(expectedName(names));
      EXPECT_EQ(path, expected) << name;
    }
  }
}

TEST(ImportTree, GeometryIsThereOnceForEachProductHoweverOftenItIsPlaced) {
  for (const auto& [name, document] : documents()) {
    std::map<std::string, std::size_t> solidsOfProduct;
    for (const json& instance : oracle().at(name))
      solidsOfProduct[instance["product"]] = instance["solids"];
    std::size_t solids = 0;
    for (const auto& product : solidsOfProduct)
      solids += product.second;
    EXPECT_EQ(document.shapes.size(), solids) << name;
  }
}

TEST(ImportTree, ColoursOfPartsAreThoseOfTheFile) {
  for (const auto& [name, document] : documents()) {
    const json& wanted = oracle().at(name);
    const std::vector<std::size_t> products = placedProducts(document);
    ASSERT_EQ(products.size(), wanted.size()) << name;
    for (std::size_t i = 0; i < products.size(); ++i) {
      const std::optional<CadColour>& colour = document.nodes[products[i]].colour;
      ASSERT_EQ(colour.has_value(), !wanted[i]["colour"].is_null()) << name;
      for (std::size_t k = 0; colour && k < 3; ++k)
        EXPECT_NEAR((*colour)[k], wanted[i]["colour"][k].get<double>(), 1e-3) << name;
    }
  }
}

/// Colours in which the faces of a placed product are drawn, and how many have each; those without a colour are left out.
std::map<CadColour, std::size_t> coloursOfFaces(const CadDocument& document, std::size_t product) {
  std::map<CadColour, std::size_t> counts;
  for (std::size_t i = 0; i < document.nodes.size(); ++i) {
    const CadNode& node = document.nodes[i];
    if (node.shape < 0 || (i != product && node.parent != static_cast<std::int32_t>(product))) continue;
    const CadShape& shape = document.shapes[static_cast<std::size_t>(node.shape)];
    for (std::size_t face = 0; face < shape.surfaces.faces.size(); ++face) {
      const std::optional<CadColour> own =
          shape.faceColours.empty() ? std::nullopt : shape.faceColours.at(face);
      const std::optional<CadColour>& drawn = own ? own : node.colour;
      if (drawn) ++counts[*drawn];
    }
  }
  return counts;
}

TEST(ImportTree, ColoursOfFacesAreThoseOfTheFile) {
  for (const auto& [name, document] : documents()) {
    const json& wanted = oracle().at(name);
    const std::vector<std::size_t> products = placedProducts(document);
    ASSERT_EQ(products.size(), wanted.size()) << name;
    for (std::size_t i = 0; i < products.size(); ++i) {
      const json& colours = wanted[i]["face_colours"];
      const std::map<CadColour, std::size_t> found = coloursOfFaces(document, products[i]);
      ASSERT_EQ(found.size(), colours.size()) << name << " " << i;
      // Both are sorted by their colours.
      std::size_t at = 0;
      for (const auto& [colour, count] : found) {
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(colour[k], colours[at][k].get<double>(), 1e-3) << name << " " << i;
        EXPECT_EQ(count, colours[at][3].get<std::size_t>()) << name << " " << i;
        ++at;
      }
    }
  }
}

TEST(ImportTree, UnitsBecomeMetresAndEveryInstanceLiesWithinItsExactBox) {
  for (const auto& [name, document] : documents()) {
    const json& wanted = oracle().at(name);
    const std::vector<std::size_t> products = placedProducts(document);
    ASSERT_EQ(products.size(), wanted.size()) << name;
    for (std::size_t i = 0; i < products.size(); ++i) {
      Aabb box;
      double chord = 0.0;
      for (std::size_t n = 0; n < document.nodes.size(); ++n) {
        if (document.nodes[n].shape < 0 ||
            (n != products[i] && document.nodes[n].parent != static_cast<std::int32_t>(products[i])))
          continue;
        const CadShape& shape = document.shapes[static_cast<std::size_t>(document.nodes[n].shape)];
        const Aabb one = boxOf(shape, test::worldFromNode(document, n));
        box.add(one.lower);
        box.add(one.upper);
        chord = std::max(chord, shape.tessellation.chord);
      }
      // Triangles lie off the surface by the chord, and the oracle's box is 1e-7 mm wider.
      const double tolerance = chord + 1e-9;
      const glm::dvec3 low = pointOf(wanted[i]["low"]), high = pointOf(wanted[i]["high"]);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(box.lower[k], low[k], tolerance) << name << " " << i;
        EXPECT_NEAR(box.upper[k], high[k], tolerance) << name << " " << i;
      }
    }
  }
}

TEST(ImportTree, ExactVolumesAreThoseOfTheSolids) {
  for (const auto& [name, document] : documents()) {
    const json& wanted = oracle().at(name);
    const std::vector<std::size_t> products = placedProducts(document);
    ASSERT_EQ(products.size(), wanted.size()) << name;
    for (std::size_t i = 0; i < products.size(); ++i) {
      double volume = 0.0;
      for (const CadShape* shape : shapesBelow(document, products[i]))
        volume += shape->exactVolume;
      const double expected = wanted[i]["volume"].get<double>() * std::pow(kMillimetre, 3);
      EXPECT_NEAR(volume, expected, 1e-5 * expected) << name;
    }
  }
}

TEST(ImportTree, TrianglesEncloseTheExactVolumeWithinTheChord) {
  for (const auto& [name, document] : documents())
    for (const CadShape& shape : document.shapes)
      EXPECT_NEAR(test::volumeOf(shape), shape.exactVolume, test::areaOf(shape) * shape.tessellation.chord)
          << name << " " << shape.key;
}

TEST(ImportTree, TrianglesOfSolidsAreClosedAndNothingIsSaidOfGaps) {
  for (const auto& [name, document] : documents()) {
    EXPECT_TRUE(document.warnings.empty()) << name << ": " << testing::PrintToString(document.warnings);
    for (const CadShape& shape : document.shapes) {
      EXPECT_EQ(test::unmatchedEdges(shape), 0U) << name << " " << shape.key;
      EXPECT_TRUE(shape.warnings.empty()) << name << ": " << testing::PrintToString(shape.warnings);
    }
  }
}

TEST(ImportTree, EveryFaceOfTheFileHasTriangles) {
  for (const auto& [name, document] : documents()) {
    const json& wanted = oracle().at(name);
    const std::vector<std::size_t> products = placedProducts(document);
    ASSERT_EQ(products.size(), wanted.size()) << name;
    for (std::size_t i = 0; i < products.size(); ++i) {
      std::size_t faces = 0;
      for (const CadShape* shape : shapesBelow(document, products[i])) {
        faces += shape->surfaces.faces.size();
        EXPECT_EQ(std::set<std::uint32_t>(shape->surfaces.faceOfTriangle.begin(),
                                          shape->surfaces.faceOfTriangle.end())
                      .size(),
                  shape->surfaces.faces.size())
            << name;
      }
      EXPECT_EQ(faces, wanted[i]["faces"].get<std::size_t>()) << name;
    }
  }
}

TEST(ImportTree, AColouredFaceKeepsItsColour) {
  const CadDocument document = imported(importModel("assembly_inch.step"));
  const auto plate =
      std::ranges::find_if(document.shapes, [](const CadShape& s) { return s.key.starts_with("Platte"); });
  ASSERT_NE(plate, document.shapes.end());
  ASSERT_EQ(plate->faceColours.size(), 6U);
  EXPECT_EQ(std::ranges::count(plate->faceColours, std::optional(CadColour{0.0F, 1.0F, 0.0F})), 1);
}

TEST(ImportTree, SolidsOfOneProductAreAGroup) {
  const CadDocument document = imported(importModel("two_solids.step"));
  ASSERT_EQ(document.nodes.size(), 3U);
  EXPECT_EQ(document.nodes[0].shape, -1);
  EXPECT_EQ(document.nodes[0].name, "pair");
  EXPECT_EQ(document.nodes[1].parent, 0);
  EXPECT_EQ(document.nodes[2].name, "pair 2");
}

TEST(ImportTree, CavitiesBelongToTheirSolid) {
  const fs::path vise = sharedModel("public/steptools_vise.stp");
  if (!fs::exists(vise)) return;
  const CadDocument document = imported(vise);
  // Five shells: a body and four cavities within it, whose triangles look inward.
  ASSERT_EQ(document.shapes.size(), 1U);
  EXPECT_NEAR(test::volumeOf(document.shapes[0]), 4032972.92e-9, 2e-5 * 4.03e-3);
}

/// The bracket with its product's name written otherwise in the file.
CadDocument named(const TemporaryFolder& folder, const std::string& text) {
  std::string step = test::readBytes(importModel("bracket.step"));
  const std::string old = "'bracket'";
  for (std::size_t at = step.find(old); at != std::string::npos; at = step.find(old, at + text.size()))
    step.replace(at, old.size(), "'" + text + "'");
  return imported(folder.write("part 7.step", step));
}

TEST(ImportTree, NamesAreReadInAllWaysThatProgramsWriteThem) {
  const TemporaryFolder folder;
  EXPECT_EQ(named(folder, "Ger\\X2\\00E4\\X0\\t").nodes[0].name, "Ger\xC3\xA4t");
  EXPECT_EQ(named(folder, "Ger\xC3\xA4t").nodes[0].name, "Ger\xC3\xA4t");
  EXPECT_EQ(named(folder, "Ger\xE4t").nodes[0].name, "Ger\xC3\xA4t");
  EXPECT_EQ(named(folder, "Ger\\S\\dt").nodes[0].name, "Ger\xC3\xA4t");
  EXPECT_EQ(named(folder, "two''s").nodes[0].name, "two's");
}

TEST(ImportTree, WhatHasNoNameGetsTheFilesNameAndANumber) {
  const TemporaryFolder folder;
  EXPECT_EQ(named(folder, "").nodes[0].name, "part 7 1");
}

}  // namespace
}  // namespace nearfit::import_tree_test
