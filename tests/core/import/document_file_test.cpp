#include "core/import/document_file.h"

#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/import/companion_files.h"

namespace nearfit::document_file_test {
namespace {

using testing::HasSubstr;

std::vector<std::byte> bytesOf(const CadDocument& document) {
  std::vector<std::byte> bytes;
  writeDocument(document, [&](std::span<const std::byte> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  });
  return bytes;
}

CadDocument reread(const CadDocument& document) {
  return readDocument(bytesOf(document), "a test");
}

ExactSurface bore() {
  ExactSurface s;
  s.kind = SurfaceKind::Cylinder;
  s.point = {1.0, 2.0, 3.0};
  s.direction = {0.6, 0.0, 0.8};
  s.radius = 0.004;
  s.isHollow = true;
  return s;
}

/// A group of two instances of a tetrahedron with two faces.
CadDocument tetrahedra() {
  CadShape shape;
  shape.key = "bracket/1";
  shape.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  shape.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  shape.surfaces.faces = {bore(), {}};
  shape.surfaces.faceOfTriangle = {0, 1, 1, 0};
  shape.faceColours = {CadColour{0.25F, 0.5F, 1.0F}, std::nullopt};
  shape.tessellation = {0.001, 0.2};
  shape.isExact = true;
  shape.exactVolume = 1.0 / 6.0;
  shape.warnings = {"It has gaps."};
  CadDocument document;
  document.shapes = {shape};
  CadNode group, first, second;
  group.name = "Baugruppe \xC3\xBC";
  first.parent = second.parent = 0;
  first.shape = second.shape = 0;
  first.name = second.name = "bracket";
  second.parentFromNode.rotation = {0.6, 0.0, 0.8, 0.0};
  second.parentFromNode.translation = {0.1, -0.2, 0.3};
  second.colour = CadColour{0.0F, 1.0F, 0.5F};
  document.nodes = {group, first, second};
  document.warnings = {"One product has no shape."};
  document.sha256 = std::string(64, 'a');
  document.companions = {{"../meshes/\xC3\xBC.stl", std::string(64, 'b')},
                         {"package://arm/cube.stl", std::string(64, 'c')}};
  return document;
}

void expectRefused(const std::function<void(CadDocument&)>& damage, const std::string& problem) {
  CadDocument document = tetrahedra();
  damage(document);
  try {
    checkDocument(document);
    ADD_FAILURE() << "was not refused: " << problem;
  } catch (const Error& error) {
    EXPECT_THAT(error.problem(), HasSubstr(problem));
  }
}

CadShape& shapeOf(CadDocument& document) {
  return document.shapes[0];
}

TEST(DocumentFile, ADocumentComesBackAsItWas) {
  CadDocument wanted = tetrahedra();
  wanted.statedUnit = 0.0254;
  const CadDocument got = reread(wanted);
  EXPECT_TRUE(got.hasUnit);
  EXPECT_EQ(got.statedUnit, 0.0254);
  EXPECT_EQ(got.sha256, wanted.sha256);
  EXPECT_EQ(got.warnings, wanted.warnings);
  ASSERT_EQ(got.shapes.size(), 1U);
  const CadShape &a = wanted.shapes[0], &b = got.shapes[0];
  EXPECT_EQ(b.key, a.key);
  EXPECT_EQ(b.vertices, a.vertices);
  EXPECT_EQ(b.triangles, a.triangles);
  EXPECT_EQ(b.surfaces.faceOfTriangle, a.surfaces.faceOfTriangle);
  EXPECT_EQ(b.faceColours, a.faceColours);
  EXPECT_EQ(b.tessellation, a.tessellation);
  EXPECT_TRUE(b.isExact);
  EXPECT_EQ(b.exactVolume, a.exactVolume);
  EXPECT_EQ(b.warnings, a.warnings);
}

TEST(DocumentFile, ExactSurfacesComeBackWithAllOfTheirNumbers) {
  CadDocument document = tetrahedra();
  ExactSurface& torus = shapeOf(document).surfaces.faces[1];
  torus.kind = SurfaceKind::Torus;
  torus.direction = {0.0, 0.0, 1.0};
  torus.radius = 0.02;
  torus.minorRadius = 0.003;
  torus.halfAngle = 0.25;
  const CadDocument got = reread(document);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(got.shapes.at(0).surfaces.faces.at(i), document.shapes[0].surfaces.faces[i]) << i;
}

TEST(DocumentFile, TheTreeComesBackWithNamesPlacesAndColours) {
  CadDocument document = tetrahedra();
  document.hasUnit = false;
  const CadDocument got = reread(document);
  EXPECT_FALSE(got.hasUnit);
  ASSERT_EQ(got.nodes.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const CadNode &a = document.nodes[i], &b = got.nodes[i];
    EXPECT_EQ(b.parent, a.parent);
    EXPECT_EQ(b.shape, a.shape);
    EXPECT_EQ(b.name, a.name);
    EXPECT_EQ(b.parentFromNode.rotation, a.parentFromNode.rotation);
    EXPECT_EQ(b.parentFromNode.translation, a.parentFromNode.translation);
    EXPECT_EQ(b.colour, a.colour);
  }
}

TEST(DocumentFile, CompanionsComeBackWithTheirHashes) {
  CadDocument document = tetrahedra();
  for (const bool areKnown : {true, false}) {
    document.areCompanionsKnown = areKnown;
    const CadDocument got = reread(document);
    EXPECT_EQ(got.areCompanionsKnown, areKnown);
    ASSERT_EQ(got.companions.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(got.companions[i].name, document.companions[i].name);
      EXPECT_EQ(got.companions[i].sha256, document.companions[i].sha256);
    }
  }
}

TEST(DocumentFile, CompanionsHaveNamesAndHashesWithinTheirLimits) {
  for (const std::string& name : {std::string(), std::string("/etc/passwd"), std::string("a\nb"),
                                  std::string("\xFF"), std::string(kMaxCompanionNameBytes + 1, 'x')})
    expectRefused([&](CadDocument& d) { d.companions[0].name = name; }, "its name is too long, absolute");
  expectRefused([](CadDocument& d) { d.companions[1].name = d.companions[0].name; }, "its name repeats");
  expectRefused([](CadDocument& d) { d.companions[1].sha256 = "abc"; }, "no SHA-256");
  expectRefused([](CadDocument& d) { d.companions.resize(kMaxCompanions + 1, d.companions[0]); },
                "there are too many");
}

TEST(DocumentFile, ADocumentOfFormatsOfTrianglesNeedsNoFaces) {
  CadDocument document = tetrahedra();
  shapeOf(document).surfaces = {};
  shapeOf(document).faceColours = {};
  EXPECT_EQ(reread(document).shapes.at(0).triangles.size(), 4U);
}

TEST(DocumentFile, EveryPrefixIsRefusedAndNamesTheFile) {
  const std::vector<std::byte> bytes = bytesOf(tetrahedra());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    try {
      readDocument(std::span(bytes).first(size), "vise.stp");
      ADD_FAILURE() << size << " of " << bytes.size() << " bytes were read";
    } catch (const FileError& error) {
      EXPECT_EQ(error.where(), "vise.stp");
      EXPECT_FALSE(error.remedy().empty());
    }
  }
}

TEST(DocumentFile, BytesAfterTheEndAreRefused) {
  std::vector<std::byte> bytes = bytesOf(tetrahedra());
  bytes.push_back(std::byte{0});
  EXPECT_THROW(readDocument(bytes, "a test"), FileError);
}

TEST(DocumentFile, FlippedBytesGiveASoundDocumentOrAnError) {
  const std::vector<std::byte> bytes = bytesOf(tetrahedra());
  std::size_t refused = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const unsigned flip : {0x01U, 0x80U, 0xFFU}) {
      std::vector<std::byte> damaged = bytes;
      damaged[i] ^= static_cast<std::byte>(flip);
      // Any other exception, or a crash, fails the test.
      try {
        checkDocument(readDocument(damaged, "a test"));
      } catch (const FileError&) {
        ++refused;
      }
    }
  }
  // A third of the flips and more: head, counts, indices, flags, texts, and exponents of unit vectors are all checked.
  EXPECT_GT(refused, bytes.size() * 3 / 4);
}

TEST(DocumentFile, RandomDamageInSeveralPlacesGivesASoundDocumentOrAnError) {
  const std::vector<std::byte> bytes = bytesOf(tetrahedra());
  std::mt19937_64 random(21);
  for (int round = 0; round < 20'000; ++round) {
    std::vector<std::byte> damaged = bytes;
    for (std::uint64_t k = 1 + random() % 4; k > 0; --k)
      damaged[random() % damaged.size()] = static_cast<std::byte>(random() & 0xFFU);
    try {
      checkDocument(readDocument(damaged, "a test"));
    } catch (const FileError&) {
    }
  }
}

TEST(DocumentFile, HugeCountsTakeNoMemory) {
  const std::vector<std::byte> bytes = bytesOf(tetrahedra());
  const std::uint64_t huge = std::uint64_t{1} << 60;
  for (std::size_t at = 16; at + sizeof(huge) <= bytes.size(); ++at) {
    std::vector<std::byte> damaged = bytes;
    std::memcpy(damaged.data() + at, &huge, sizeof(huge));
    try {
      readDocument(damaged, "a test");
    } catch (const FileError&) {
    }
  }
}

TEST(DocumentFile, IndicesOutOfRangeAreRefused) {
  expectRefused([](CadDocument& d) { shapeOf(d).triangles[1][2] = 4; }, "corners do not exist");
  expectRefused([](CadDocument& d) { shapeOf(d).triangles[1] = {1, 1, 2}; },
                "corners do not exist or repeat");
  expectRefused([](CadDocument& d) { shapeOf(d).surfaces.faceOfTriangle[0] = 2; }, "face does not exist");
  expectRefused([](CadDocument& d) { shapeOf(d).surfaces.faceOfTriangle.pop_back(); },
                "each triangle has a face");
  expectRefused([](CadDocument& d) { shapeOf(d).faceColours.pop_back(); }, "each face has a colour");
  expectRefused([](CadDocument& d) { d.nodes[1].shape = 1; }, "shape does not exist");
  expectRefused([](CadDocument& d) { d.nodes[1].shape = -2; }, "shape does not exist");
}

TEST(DocumentFile, CyclesAndParentsBehindTheirChildrenAreRefused) {
  expectRefused([](CadDocument& d) { d.nodes[0].parent = 0; }, "parent does not come before");
  expectRefused([](CadDocument& d) { d.nodes[1].parent = 2; }, "parent does not come before");
  expectRefused([](CadDocument& d) { d.nodes[2].parent = 1; }, "parent is an instance");
  expectRefused([](CadDocument& d) { d.nodes[2].parent = -2; }, "parent does not come before");
}

TEST(DocumentFile, NestingIsAllowedToItsLimitOnly) {
  CadDocument document = tetrahedra();
  document.nodes.resize(1);
  const auto nest = [&] {
    document.nodes.push_back(document.nodes[0]);
    document.nodes.back().parent = static_cast<std::int32_t>(document.nodes.size()) - 2;
  };
  while (document.nodes.size() < kMaxDocumentDepth)
    nest();
  EXPECT_NO_THROW(checkDocument(document));
  nest();
  EXPECT_THROW(checkDocument(document), Error);
}

TEST(DocumentFile, NumbersThatAreNotFiniteAreRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                   kInf = std::numeric_limits<double>::infinity();
  for (const double bad : {kNan, kInf, -kInf, 1e13}) {
    expectRefused([&](CadDocument& d) { shapeOf(d).vertices[3].y = bad; }, "vertex is out of range");
    expectRefused([&](CadDocument& d) { d.nodes[2].parentFromNode.translation.z = bad; },
                  "place is out of range");
    expectRefused([&](CadDocument& d) { d.nodes[2].parentFromNode.rotation.x = bad; },
                  "place is out of range");
    expectRefused([&](CadDocument& d) { shapeOf(d).surfaces.faces[0].point.x = bad; }, "impossible sizes");
    expectRefused([&](CadDocument& d) { shapeOf(d).surfaces.faces[0].radius = bad; }, "impossible sizes");
    expectRefused([&](CadDocument& d) { shapeOf(d).tessellation.chord = bad; },
                  "tessellation is out of range");
  }
  for (const double bad : {kNan, kInf, 0.0, -1.0})
    expectRefused([&](CadDocument& d) { d.statedUnit = bad; }, "out of range");
  expectRefused([&](CadDocument& d) { shapeOf(d).exactVolume = kInf; }, "volume is out of range");
  expectRefused([&](CadDocument& d) { shapeOf(d).exactVolume = -1.0; }, "volume is out of range");
}

TEST(DocumentFile, DirectionsAndRotationsHaveUnitLength) {
  expectRefused([](CadDocument& d) { shapeOf(d).surfaces.faces[0].direction.x = 0.61; }, "impossible sizes");
  expectRefused([](CadDocument& d) { shapeOf(d).surfaces.faces[0].direction = glm::dvec3(0.0); },
                "impossible sizes");
  expectRefused([](CadDocument& d) { d.nodes[2].parentFromNode.rotation.w = 0.61; }, "place is out of range");
}

TEST(DocumentFile, ColoursLieBetweenZeroAndOne) {
  expectRefused([](CadDocument& d) { d.nodes[2].colour = CadColour{0.0F, 1.5F, 0.0F}; },
                "colour is out of range");
  expectRefused([](CadDocument& d) { shapeOf(d).faceColours[0] = CadColour{std::nanf(""), 0.0F, 0.0F}; },
                "colour is out of range");
}

TEST(DocumentFile, TextsArePrintableUtf8WithinTheirLimits) {
  expectRefused([](CadDocument& d) { d.nodes[0].name = "\xFF"; }, "no printable text");
  expectRefused([](CadDocument& d) { d.nodes[0].name = "two\nlines"; }, "no printable text");
  expectRefused([](CadDocument& d) { d.nodes[0].name = std::string(kMaxNodeNameBytes + 1, 'x'); },
                "too long");
  expectRefused([](CadDocument& d) { shapeOf(d).key.clear(); }, "key is empty");
  expectRefused([](CadDocument& d) { shapeOf(d).warnings = {std::string(kMaxWarningBytes + 1, 'x')}; },
                "too long");
  expectRefused([](CadDocument& d) { d.warnings.assign(kMaxWarnings + 1, "again"); }, "too many warnings");
  expectRefused([](CadDocument& d) { d.sha256 = std::string(64, 'g'); }, "no SHA-256");
}

TEST(DocumentFile, KeysAreUnique) {
  expectRefused([](CadDocument& d) { d.shapes.push_back(d.shapes[0]); }, "key repeats");
}

TEST(DocumentFile, AShapeHasTriangles) {
  expectRefused(
      [](CadDocument& d) {
        shapeOf(d).triangles.clear();
        shapeOf(d).surfaces.faceOfTriangle.clear();
      },
      "no triangles");
}

TEST(DocumentFile, WhatBreaksALimitIsNotWrittenEither) {
  CadDocument document = tetrahedra();
  document.nodes[1].shape = 7;
  EXPECT_THROW(bytesOf(document), Error);
}

}  // namespace
}  // namespace nearfit::document_file_test
