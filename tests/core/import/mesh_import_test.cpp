#include "core/import/mesh_import.h"

#include <algorithm>
#include <clocale>
#include <cmath>
#include <locale>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "core/mesh/mass_properties.h"
#include "tests/support/mesh_files.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::mesh_import_test {
namespace {

using testing::Contains;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

/// A file's name and its content.
struct NamedContent {
  std::string name, content;
};

const std::string kBoxObj = test::objText(test::boxMesh({1, 2, 3}));

std::vector<NamedContent> everyFormat(const TriangleMesh& mesh) {
  return {{"binary.stl", test::stlBinary(mesh)},
          {"solid.stl", test::stlBinary(mesh, "solid that is binary all the same")},
          {"text.stl", test::stlText(mesh)},
          {"mesh.obj", test::objText(mesh)},
          {"mesh.off", test::offText(mesh)},
          {"text.ply", test::plyText(mesh)},
          {"little.ply", test::plyBinary(mesh, test::ByteOrder::Little)},
          {"big.ply", test::plyBinary(mesh, test::ByteOrder::Big)}};
}

std::vector<NamedContent> everyTextFormat(const TriangleMesh& mesh) {
  return {{"text.stl", test::stlText(mesh)},
          {"mesh.obj", test::objText(mesh)},
          {"mesh.off", test::offText(mesh)},
          {"text.ply", test::plyText(mesh)}};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

class MeshImport : public testing::Test {
 protected:
  ImportedMesh import(const NamedContent& file) {
    return importMesh(folder_.write(file.name, file.content), {});
  }
  ImportedMesh import(const std::string& name, const std::string& content) {
    return import(NamedContent{name, content});
  }

  /// The error that importing gives; its place begins with the path.
  FileError refusal(const std::string& name, const std::string& content) {
    const std::filesystem::path file = folder_.write(name, content);
    return refusal(file);
  }
  FileError refusal(const std::filesystem::path& file) {
    try {
      importMesh(file, {});
    } catch (const FileError& error) {
      EXPECT_THAT(error.where(), testing::StartsWith(file.string()));
      EXPECT_FALSE(error.remedy().empty());
      return error;
    }
    ADD_FAILURE() << file << " was not refused";
    return FileError("", "");
  }
  /// Imports a box in some disguise.
  void expectBox(const std::string& name, const std::string& content) {
    SCOPED_TRACE(name);
    const ImportedMesh imported = import(name, content);
    EXPECT_EQ(imported.mesh.triangles().size(), 12U);
    EXPECT_EQ(imported.mesh.vertices().size(), 8U);
    EXPECT_NEAR(massProperties(imported.mesh).volume, 6.0, 1e-14);
    EXPECT_THAT(imported.report.warnings, IsEmpty());
  }

  test::TemporaryFolder folder_;
};

TEST_F(MeshImport, EveryFormatGivesTheMeshThatWasWritten) {
  const TriangleMesh mesh = test::starMesh(1, 0.1, 2, 0.3);
  for (const NamedContent& file : everyFormat(mesh)) {
    SCOPED_TRACE(file.name);
    const ImportedMesh imported = import(file);
    EXPECT_EQ(imported.mesh.triangles().size(), mesh.triangles().size());
    EXPECT_EQ(imported.mesh.vertices().size(), mesh.vertices().size());
    EXPECT_TRUE(imported.mesh.topology().isClosed() && imported.mesh.topology().isOriented());
    const bool isSinglePrecision = file.name == "binary.stl" || file.name == "solid.stl";
    const double precision = isSinglePrecision ? 1e-8 : 0.0;
    for (std::size_t i = 0; i < mesh.triangles().size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        const glm::dvec3 expected = mesh.vertices()[mesh.triangles()[i][k]];
        const glm::dvec3 actual = imported.mesh.vertices()[imported.mesh.triangles()[i][k]];
        EXPECT_LE(glm::distance(actual, expected), precision);
      }
    }
    EXPECT_THAT(imported.report.warnings, IsEmpty());
    EXPECT_EQ(imported.sha256, sha256OfBytes(file.content));
  }
}

TEST_F(MeshImport, ContentTellsTheFormatWhateverTheName) {
  const TriangleMesh mesh = test::boxMesh({1, 2, 3});
  for (const NamedContent& file : everyFormat(mesh)) {
    if (file.name == "mesh.obj") continue;  // Nothing in an OBJ file says that it is one.
    expectBox("wrong.obj", file.content);
    expectBox("none", file.content);
  }
}

TEST_F(MeshImport, UpperCaseEndingsAndOddNamesAreRead) {
  for (const char* name :
       {"BOX.OBJ", "with space.obj", "#1 50%.obj", "m\xC3\xBCtter.obj", "\xE9\xAD\x9A.obj", "a.b.c.obj"}) {
    expectBox(name, kBoxObj);
  }
  expectBox("BOX.STL", test::stlText(test::boxMesh({1, 2, 3})));
}

TEST_F(MeshImport, LineEndsOfAllKindsAreRead) {
  for (const NamedContent& file : everyTextFormat(test::boxMesh({1, 2, 3}))) {
    expectBox(file.name, replaced(file.content, "\n", "\r\n"));
    expectBox(file.name, replaced(file.content, "\n", "\r"));
    expectBox(file.name, replaced(file.content, "\n", "  \t\n\n"));
    expectBox(file.name, file.content.substr(0, file.content.size() - 1));
  }
}

TEST_F(MeshImport, BinaryPlyMayHaveAHeaderOfAnyLineEnd) {
  const std::string bytes = test::plyBinary(test::boxMesh({1, 2, 3}));
  const std::size_t data = bytes.find("end_header\n") + 11;
  expectBox("crlf.ply", replaced(bytes.substr(0, data), "\n", "\r\n") + bytes.substr(data));
  expectBox("cr.ply", replaced(bytes.substr(0, data), "\n", "\r") + bytes.substr(data));
  // A first data byte that is a line feed belongs to the data.
  std::string shifted = bytes;
  shifted[data] = '\n';
  EXPECT_EQ(import("cr2.ply", replaced(shifted.substr(0, data), "\n", "\r") + shifted.substr(data))
                .mesh.vertices()
                .size(),
            8U);
}

std::string utf16(const std::string& text, bool isBigEndian) {
  std::string result = isBigEndian ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) {
    if (isBigEndian) result += '\0';
    result += c;
    if (!isBigEndian) result += '\0';
  }
  return result;
}

TEST_F(MeshImport, ByteOrderMarksAndUtf16AreRead) {
  for (const NamedContent& file : everyTextFormat(test::boxMesh({1, 2, 3}))) {
    expectBox(file.name, "\xEF\xBB\xBF" + file.content);
    expectBox(file.name, utf16(file.content, true));
    expectBox(file.name, utf16(file.content, false));
    expectBox(file.name, utf16(file.content, false) + "x");  // Half a character too many.
  }
}

struct CommaPunctuation : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST_F(MeshImport, LocaleDoesNotMatter) {
  // Debian's plain C library has no comma locale; where one is installed, it is tried as well.
  const std::string before = std::setlocale(LC_ALL, nullptr);
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  const std::locale previous = std::locale::global(std::locale(std::locale::classic(), new CommaPunctuation));
  for (const NamedContent& file : everyFormat(test::boxMesh({1, 2, 3})))
    expectBox(file.name, file.content);
  const FileError error = refusal("x.obj", "v 0 0 0\nv 0 x 0\n");
  std::locale::global(previous);
  std::setlocale(LC_ALL, before.c_str());
  EXPECT_THAT(error.where(), EndsWith("x.obj:2"));
}

TEST_F(MeshImport, DecimalCommasAreRefusedWithTheRemedy) {
  for (const NamedContent& file : everyTextFormat(test::boxMesh({1.5, 2.5, 3.5}))) {
    const std::size_t header = file.name == "text.ply" ? file.content.find("end_header") : 0;
    const std::string commas =
        file.content.substr(0, header) + replaced(file.content.substr(header), ".", ",");
    EXPECT_THAT(refusal(file.name, commas).remedy(), HasSubstr("decimal points instead of commas"))
        << file.name;
  }
}

TEST_F(MeshImport, FacesWithoutFiniteCoordinatesAreLeftOutWithAWarning) {
  const std::string extra = "v nan 0 0\nv 1e999 0 0\nv 0 -inf 0\nf 1 2 9\nf 1 10 3\nf 11 1 2\n";
  const ImportedMesh imported = import("x.obj", kBoxObj + extra);
  EXPECT_TRUE(imported.mesh.topology().isClosed());
  EXPECT_EQ(imported.report.nonFiniteFaces, 3U);
  EXPECT_THAT(imported.report.warnings, Contains(HasSubstr("3 faces have coordinates that are not finite")));
}

TEST_F(MeshImport, BinaryStlFacetsThatAreNotFiniteAreLeftOutAndHarmNoOthers) {
  std::string bytes =
      test::stlBinary(test::joined(test::boxMesh({1, 2, 3}), test::boxMesh({1, 2, 3}, {9, 0, 0})));
  const std::string nan("\0\0\xC0\x7F", 4), infinity("\0\0\x80\xFF", 4);
  bytes.replace(84 + 50 * 0 + 12, 4, nan);
  bytes.replace(84 + 50 * 5 + 24, 4, infinity);
  bytes.replace(84 + 50 * 6 + 0, 4, nan);  // A normal does not matter.
  const ImportedMesh imported = import("x.stl", bytes);
  EXPECT_EQ(imported.mesh.triangles().size(), 22U);
  EXPECT_EQ(imported.mesh.vertices().size(), 16U);
  EXPECT_EQ(imported.report.nonFiniteFaces, 2U);
}

TEST_F(MeshImport, BinaryStlFacetsWithEqualCornersAreCounted) {
  std::string bytes = test::stlBinary(test::joined(test::boxMesh({1, 2, 3}), test::tetrahedronMesh()));
  for (int facet = 12; facet < 16; ++facet)
    bytes.replace(84 + 50 * facet + 12, 12, bytes.substr(84 + 50 * facet + 24, 12));
  const ImportedMesh imported = import("x.stl", bytes);
  EXPECT_EQ(imported.mesh.triangles().size(), 12U);
  EXPECT_EQ(imported.report.degenerateFaces, 4U);
}

TEST_F(MeshImport, BytesBehindABinaryStlAreLeftOutWithAWarning) {
  const std::string bytes = test::stlBinary(test::boxMesh({1, 2, 3})) + std::string(7, '\0');
  EXPECT_THAT(import("x.stl", bytes).report.warnings,
              Contains(HasSubstr("7 bytes after the last of 12 triangles")));
}

TEST_F(MeshImport, StlTextIsReadAsProgramsWriteIt) {
  const std::string text = test::stlText(test::boxMesh({1, 2, 3}));
  expectBox("x.stl", replaced(text, "solid test", "solid facet normal outer loop vertex 1 2 3 endsolid"));
  expectBox("x.stl", replaced(replaced(text, "facet", "FACET"), "vertex", "Vertex"));
  expectBox("x.stl", replaced(text, "normal 0 0 0", "normal -nan(ind) x nan"));
  expectBox("x.stl", replaced(text, "normal 0 0 0", ""));
  expectBox("x.stl", replaced(text, "\n", " # a comment\n"));
  expectBox("x.stl", "# a comment\n" + text.substr(text.find('\n') + 1));
  const std::string second = test::stlText(test::boxMesh({1, 2, 3}, {9, 0, 0}));
  EXPECT_EQ(import("x.stl", text + second).mesh.topology().components, 2U);
}

TEST_F(MeshImport, StlTextWithoutItsEndIsReadWithAWarning) {
  const std::string text = test::stlText(test::boxMesh({1, 2, 3}));
  const std::string cut = text.substr(0, text.rfind("endsolid"));
  EXPECT_THAT(import("x.stl", cut).report.warnings, Contains(HasSubstr("ends without 'endsolid'")));
}

TEST_F(MeshImport, ObjIsReadAsProgramsWriteIt) {
  expectBox("x.obj", replaced(kBoxObj, "f ", "f \\\n "));
  expectBox("x.obj", replaced(kBoxObj, "\nv ", "\nv\t"));
  const std::string vertices = kBoxObj.substr(0, kBoxObj.find("f ")),
                    faces = kBoxObj.substr(kBoxObj.find("f "));
  expectBox("x.obj", faces + vertices);  // Faces may come first.
  expectBox("x.obj", replaced(vertices, "\nv", " 0.5 nan 1\nv") + faces);
  expectBox("x.obj", vertices + replaced(replaced(faces, " 1", " 1//4"), " 2", " 2/3/4"));
  // mtllib must not be opened: this one would never end.
  expectBox("x.obj", "mtllib /dev/zero\nvn 1 2\nvt x\ng a\ncurv 1 2 \\\n3 4\n" + kBoxObj + "usemtl none\n");
  const TriangleMesh box = test::boxMesh({1, 2, 3});
  std::string negative;
  for (const Triangle& t : box.triangles()) {
    negative += "f";
    for (const std::uint32_t v : t)
      negative += " " + std::to_string(static_cast<int>(v) - 8);
    negative += "\n";
  }
  expectBox("x.obj", vertices + negative);
}

TEST_F(MeshImport, OffIsReadAsProgramsWriteIt) {
  const std::string text = test::offText(test::boxMesh({1, 2, 3}));
  const std::string body = text.substr(text.find('\n') + 1);
  expectBox("x.off", "OFF" + body);
  expectBox("x.off", "OFF " + body);
  expectBox("x.off", body);
  expectBox("x.off", "# a comment\n\n  OFF # another\n# and one\n" + replaced(body, "\n", " # note\n"));
  expectBox("x.off", replaced(replaced(text, "\n", " 0.1 0.2 0.3 1\n"), "OFF 0.1 0.2 0.3 1", "COFF"));
  expectBox("x.off", "nOFF 3\n" + body);
  const std::size_t faces = body.find("\n3 ");
  const std::size_t vertices = body.find('\n');
  expectBox("x.off", "4OFF\n" + body.substr(0, vertices) +
                         replaced(body.substr(vertices, faces - vertices), "\n", " 1\n").substr(2) + " 1" +
                         body.substr(faces));
}

const std::string kPlyStart = "ply\nformat ascii 1.0\n";
const std::string kPlyXyz = "property float x\nproperty float y\nproperty float z\n";

TEST_F(MeshImport, PlyIsReadWhateverElseItHolds) {
  const std::string text =
      kPlyStart +
      "obj_info by hand\nelement camera 2\nproperty list int float view\nproperty char mode\n"
      "element face 2\nproperty list ushort short flags\nproperty list uint uchar vertex_index\nproperty "
      "uchar red\n"
      "element vertex 4\nproperty uchar red\nproperty double z\nproperty int y\nproperty list uchar float u\n"
      "property short x\nelement rest 1\nproperty float a\nend_header\n"
      "2 0.5 1.5 -1\n0 1\n"
      "1 -7 3 0 1 2 255\n0 3 0 2 3 0\n"
      "9 0 0 2 0.1 0.2 0\n9 0 0 0 1\n9 0 1 0 1\n9 0.25 1 1 8 0\n"
      "3.5\n";
  const ImportedMesh imported = import("x.ply", text);
  ASSERT_EQ(imported.mesh.vertices().size(), 4U);
  EXPECT_EQ(imported.mesh.triangles().size(), 2U);
  EXPECT_EQ(imported.mesh.vertices()[3], glm::dvec3(0, 1, 0.25));
}

TEST_F(MeshImport, FaultsAreNamedWithTheirPlace) {
  struct Case {
    std::string name, content, place, problem;
  };
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  const std::string plyFaces =
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
  const std::string ply = kPlyStart + "element vertex 3\n" + kPlyXyz + plyFaces;
  const std::vector<Case> cases{
      {"x.obj", "v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n", ":3", "fewer than three coordinates"},
      {"x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 3.1+e2\n", ":3", "'3.1+e2' is not a number"},
      {"x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0x1\n", ":3", "'0x1' is not a number"},
      {"x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", ":4", "vertex 4 of 3"},
      {"x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 0 1 2\n", ":5", "vertex 0 of 3"},
      {"x.obj", "v 0 0 0\nf -2 1 1\nv 1 0 0\nv 0 1 0\n", ":2", "vertex -2 of 3"},
      {"x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n", ":4", "is not one"},
      {"x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 /2 3\n", ":4", "'/2' is not one"},
      {"x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "x.obj", "3 points but no faces"},
      {"x.obj", "hello\n", "x.obj", "no faces"},
      {"x.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "x.obj", "none of its faces has an area"},
      {"x.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n", "x.obj", "from the origin: 1e+30 m"},
      {"x.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", ":6", "vertices go from 0 to 2"},
      {"x.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", ":7", "the file ends where"},
      {"x.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2000000000 0 1 2\n", ":6", "declares 2000000000 corners"},
      {"x.off", "OFF\n3 4000000000 0\n0 0 0\n1 0 0\n0 1 0\n", ":2", "declares 4000000000 faces"},
      {"x.off", "OFF\n-3 1 0\n", ":2", "declares -3 vertices"},
      {"x.off", "OFF BINARY\n", ":1", "binary OFF"},
      {"x.off", "nOFF\n4\n1 1 0\n", ":2", "not three-dimensional"},
      {"x.off", "hello\n", ":1", "does not begin with OFF"},
      {"x.stl", "solid x\n" + facet + "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0\n", ":13",
       "the file ends where"},
      {"x.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\n",
       ":6", "fewer than three vertices"},
      {"x.stl", "solid x\nfacet normal 0 0 1\nvertex 0 0 0\n", ":", "'outer"},
      {"x.stl", "solid x\n" + facet + "facett\n", ":9", "found 'facett'"},
      {"x.stl", "solid x\nendsolid x\n", "x.stl", "no faces"},
      {"x.stl", test::stlBinary(test::boxMesh({1, 1, 1})).substr(0, 400), "byte 400",
       "declares 12 triangles"},
      {"x.stl", std::string("\0\0\0", 3), "x.stl", "fewer than the header"},
      {"x.ply", ply + "3 0 1 -1\n", ":13", "a face refers to vertex -1"},
      {"x.ply", ply + "3 0 1 3\n", ":13", "vertices go from 0 to 2"},
      {"x.ply", ply + "3 0 1 1.5\n", ":13", "a face refers to vertex 1.5"},
      {"x.ply", ply + "-3 0 1 2\n", ":13", "a list has -3 values"},
      {"x.ply", ply + "999999999 0 1 2\n", ":13", "does not fit"},
      {"x.ply", ply + "3 0 1\n", ":14", "the file ends where"},
      {"x.ply", kPlyStart + "element vertex 4000000000\n" + kPlyXyz + plyFaces, ":10",
       "declares 4000000000 elements 'vertex'"},
      {"x.ply", kPlyStart + "element vertex 99999999999999999999\n", ":3", "needs a name and a count"},
      {"x.ply", kPlyStart + "element vertex 3\nproperty float x\n", ":", "the file ends where 'end_header'"},
      {"x.ply", kPlyStart + "element vertex 3\nproperty floot x\n", ":4", "'floot' is not one"},
      {"x.ply", kPlyStart + "element vertex 3\nelement vertex 3\n", ":4", "declared twice"},
      {"x.ply", kPlyStart + "property float x\n", ":3", "before the first element"},
      {"x.ply", kPlyStart + "element vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n", ":",
       "one property 'z'"},
      {"x.ply", "ply\nformat ebcdic 1.0\n", ":2", "'ebcdic' is unknown"},
      {"x.ply", "ply\nend_header\n", ":2", "names no format"},
      {"x.ply",
       kPlyStart + "element vertex 0\n" + kPlyXyz +
           "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0\n",
       ":", "strips"},
      {"x.ply", "hello\n", ":1", "does not begin with 'ply'"},
      {"x.stl", "", "x.stl", "is empty"},
      {"x.xyz", "hello\n", "x.xyz", "Nearfit does not read"},
      {"x.ply.gz", "\x1f\x8b\x08", "x.ply.gz", "compression is damaged"},
      {"x.stl", "ISO-10303-21;\n", "x.stl", "STEP file by another name"},
      {"x.glb", "glTF\x02", "x.glb", "glTF file by another name"},
      {"x.gltf", "{}", "x.gltf", "JSON or glTF file"},
      {"x.xacro", "<robot/>", "x.xacro", "template of a URDF file"},
      {"x.3mf", "PK\x03\x04", "x.3mf", "archive (zip, 3MF)"},
  };
  for (const Case& c : cases) {
    const FileError error = refusal(c.name, c.content);
    EXPECT_THAT(error.where(), HasSubstr(c.place)) << error.what() << "\n" << c.content;
    EXPECT_THAT(error.problem(), HasSubstr(c.problem)) << error.what() << "\n" << c.content;
  }
}

TEST_F(MeshImport, MissingFileFolderAndPipeAreRefused) {
  EXPECT_THAT(refusal(folder_.path() / "none.stl").problem(), HasSubstr("no such file"));
  EXPECT_THAT(refusal(folder_.path()).problem(), HasSubstr("is a folder"));
  const std::filesystem::path pipe = folder_.path() / "pipe.stl";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(refusal(pipe).problem(), HasSubstr("not a regular file"));
}

TEST_F(MeshImport, FileThatMayNotBeReadIsRefused) {
  const std::filesystem::path file = folder_.write("x.obj", kBoxObj);
  ASSERT_EQ(::chmod(file.c_str(), 0), 0);
  if (::geteuid() != 0) {
    EXPECT_THAT(refusal(file).problem(), HasSubstr("no permission to read"));
  } else {
    EXPECT_EQ(importMesh(file, {}).mesh.triangles().size(), 12U);  // The administrator may read everything.
  }
}

TEST_F(MeshImport, UnitThatMakesNoSenseIsTheCallersFault) {
  const std::filesystem::path file = folder_.write("x.obj", kBoxObj);
  EXPECT_THROW(importMesh(file, {.metresPerUnit = -1.0}), UsageError);
}

TEST_F(MeshImport, ProgressGrowsFromStartToEnd) {
  for (const NamedContent& file : everyFormat(test::icosphereMesh(1, 6))) {
    std::vector<double> fractions;
    importMesh(folder_.write(file.name, file.content), {}, [&](double fraction) {
      fractions.push_back(fraction);
      return true;
    });
    EXPECT_GE(fractions.size(), 5U) << file.name;
    EXPECT_TRUE(std::ranges::is_sorted(fractions)) << file.name;
    EXPECT_GE(fractions.front(), 0.0);
    EXPECT_EQ(fractions.back(), 1.0);
  }
}

TEST_F(MeshImport, CancelStopsAtEveryStage) {
  for (const NamedContent& file : everyFormat(test::icosphereMesh(1, 6))) {
    const std::filesystem::path path = folder_.write(file.name, file.content);
    for (const double stop : {0.0, 0.3, 0.6, 1.0}) {
      EXPECT_THROW(importMesh(path, {}, [&](double fraction) { return fraction < stop; }), Cancelled)
          << file.name;
    }
  }
}

TEST_F(MeshImport, BoundsAreThoseOfTheMeshWithoutBuildingIt) {
  const TriangleMesh mesh = test::boxMesh({1, 2, 3}, {10, -20, 0.5});
  for (const NamedContent& file : everyFormat(mesh)) {
    const Aabb box = readMeshBounds(folder_.write(file.name, file.content));
    EXPECT_LE(glm::distance(box.lower, {9.5, -21, -1}), 1e-6) << file.name;
    EXPECT_LE(glm::distance(box.upper, {10.5, -19, 2}), 1e-6) << file.name;
  }
}

TEST_F(MeshImport, BoundsLeaveOutWhatNoFaceUsesAndWhatIsNotFinite) {
  const std::string extra = "v 100 0 0\nv nan 0 0\nv 0 -inf 0\nf 1 2 10\nf 11 1 2\n";
  const Aabb box = readMeshBounds(folder_.write("box.obj", kBoxObj + extra));
  EXPECT_LE(glm::distance(box.lower, {-0.5, -1, -1.5}), 1e-12);
  EXPECT_LE(glm::distance(box.upper, {0.5, 1, 1.5}), 1e-12);
}

TEST_F(MeshImport, BoundsOfABadFileAreRefusedAsTheFileIs) {
  EXPECT_THROW(readMeshBounds(folder_.path() / "missing.stl"), FileError);
  EXPECT_THROW(readMeshBounds(folder_.write("empty.stl", "")), FileError);
  EXPECT_THROW(readMeshBounds(folder_.write("points.obj", "v 0 0 0\nv 1 0 0\n")), FileError);
  EXPECT_THROW(readMeshBounds(folder_.write("box.obj", kBoxObj), [](double) { return false; }), Cancelled);
}

TEST_F(MeshImport, ImportableExtensionsAreThoseOfTheFormats) {
  EXPECT_THAT(importableExtensions(), testing::ElementsAre("stl", "obj", "ply", "off"));
}

}  // namespace
}  // namespace nearfit::mesh_import_test
