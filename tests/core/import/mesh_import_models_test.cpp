// Meshes that others drew, where they lie beside the repository, against the counts of another program in
// their manifest. Where they do not, the generated meshes of the other import tests stand in for them.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/import/mesh_import.h"
#include "tests/support/limited_process.h"
#include "tests/support/mesh_files.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::mesh_import_models_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kModels = test::sharedFolder() / "models";

/// A line of MANIFEST.tsv, by column.
using ManifestEntry = std::map<std::string, std::string>;

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, separator);)
    fields.push_back(field);
  return fields;
}

std::vector<ManifestEntry> manifest() {
  std::vector<ManifestEntry> entries;
  std::ifstream file(kModels / "MANIFEST.tsv");
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> columns = split(line, '\t');
  while (std::getline(file, line)) {
    const std::vector<std::string> fields = split(line, '\t');
    ManifestEntry entry;
    for (std::size_t i = 0; i < fields.size() && i < columns.size(); ++i)
      entry[columns[i]] = fields[i];
    const std::vector<std::string>& known = importableExtensions();
    if (std::ranges::count(known, entry["format"]) == 1) entries.push_back(entry);
  }
  return entries;
}

/// Files that are refused, and what the message says.
const std::map<std::string, std::string> kRefusals{
    {"nasty/stl_empty.stl", "holds no faces"},
    {"nasty/obj_out_of_range.obj", "vertex 12 of 8"},
    {"nasty/obj_number_formats.obj", "'3.1+e2' is not a number"},
    {"nasty/obj_zero_index.obj", "vertex 0 of 4"},
    {"nasty/obj_inf_nan.obj", "finite coordinates"},
    {"nasty/ply_fuzz_truncated.ply", "the line ends"},
    {"nasty/ply_no_faces.ply", "1024 points but no faces"},
    {"nasty/off_huge_count.off", "declares 353535235358 vertices"},
};

struct EdgeCounts {
  std::uint32_t open, nonManifold, inconsistent;
  bool operator==(const EdgeCounts&) const = default;
};
void PrintTo(const EdgeCounts& c, std::ostream* out) {
  *out << c.open << " open, " << c.nonManifold << " non-manifold, " << c.inconsistent << " inconsistent";
}

/// Where the manifest's counts are not those of the mesh that should come out, and why. Those of STL files
/// were counted by a script of its own, which welds by sorting and comparing and drops faces with coinciding
/// corners.
const std::map<std::string, EdgeCounts> kOtherCounts{
    // Vertices 3e-16 apart: the reference joined equal ones only.
    {"nasty/stl_cad_tjunctions.STL", {0, 0, 0}},
    {"public/unitree_dex1/meshes/base_link.STL", {948, 67, 0}},
    // The reference cut concave polygons into fans. A simple polygon of 64 corners has 64 open edges; the
    // wall with
    // a hole is closed.
    {"nasty/obj_concave_polygon.obj", {64, 0, 0}},
    {"nasty/obj_wallhole.obj", {0, 0, 0}},
    // The reference counted edges of faces with coinciding corners.
    {"nasty/stl_motor_nonmanifold.stl", {0, 168, 0}},
    {"public/pump/Axis_of_bearing.stl", {0, 94, 0}},
    // The reference misread the doubles (a box of 1e275): five Platonic solids side by side, all closed.
    {"nasty/ply_big_endian_doubles.ply", {0, 0, 0}},
};

/// Files with cracks that importing closes, the manifest being of before: how many vertices lie on open edges
/// (counted by a script of its own), each of which splits a triangle.
const std::map<std::string, std::size_t> kStitched{
    {"public/gears/factory_gear_base_loose_space_5e-4_subdiv_4x.obj", 60},
    {"public/nutbolt/factory_nut_m16_loose_subdiv_3x.obj", 84},
    {"public/peghole/factory_round_hole_16mm_subdiv_3x.obj", 28},
    {"public/peghole/factory_rectangular_hole_12mm_subdiv_3x.obj", 56},
};
/// One that is torn besides, so that stitching leaves open edges.
constexpr const char* kTorn = "public/unitree_dex1/meshes/base_link.STL";

EdgeCounts expectedCounts(const ManifestEntry& entry) {
  if (const auto other = kOtherCounts.find(entry.at("path")); other != kOtherCounts.end())
    return other->second;
  const auto number = [&](const char* column) {
    return static_cast<std::uint32_t>(std::stoul(entry.at(column)));
  };
  return {number("open_edges"), number("nonmanifold_edges"), number("inconsistent_edges")};
}

glm::dvec3 parsePoint(const std::string& text) {
  glm::dvec3 p;
  std::istringstream(text) >> p.x >> p.y >> p.z;
  return p;
}

void expectAsInManifest(const ManifestEntry& entry, const ImportedMesh& imported) {
  const MeshBuildReport& report = imported.report;
  const MeshTopology& topology = imported.mesh.topology();
  const std::size_t faces = imported.mesh.triangles().size() + report.degenerateFaces + report.duplicateFaces;
  const auto stitched = kStitched.find(entry.at("path"));
  if (entry.at("path") == kTorn) {
    EXPECT_GT(report.stitchedEdges, 0U);
    EXPECT_GT(faces, std::stoul(entry.at("triangles")));
  } else {
    EXPECT_EQ(faces,
              std::stoul(entry.at("triangles")) + (stitched != kStitched.end() ? stitched->second : 0));
    EXPECT_EQ(report.stitchedEdges, stitched != kStitched.end() ? expectedCounts(entry).open : 0U);
  }
  EXPECT_EQ((EdgeCounts{topology.openEdges + static_cast<std::uint32_t>(report.stitchedEdges),
                        topology.nonManifoldEdges, topology.inconsistentEdges}),
            expectedCounts(entry));
  EXPECT_EQ(imported.sha256, entry.at("sha256"));
  if (entry.at("path") == "nasty/ply_big_endian_doubles.ply") return;
  const double sixDigits =
      1e-5 * imported.mesh.bounds().diagonal() + 1e-5 * glm::length(imported.mesh.bounds().upper);
  EXPECT_LE(glm::distance(imported.mesh.bounds().lower, parsePoint(entry.at("bbox_min"))), sixDigits);
  EXPECT_LE(glm::distance(imported.mesh.bounds().upper, parsePoint(entry.at("bbox_max"))), sixDigits);
}

void expectEdgeWarnings(const ImportedMesh& imported) {
  const std::string all = testing::PrintToString(imported.report.warnings);
  const MeshTopology& topology = imported.mesh.topology();
  for (const auto& [count, word] : {std::pair{topology.openEdges, " open"},
                                    {topology.nonManifoldEdges, " non-manifold"},
                                    {topology.inconsistentEdges, " inconsistent"}}) {
    if (count > 0) {
      EXPECT_THAT(all, HasSubstr(std::to_string(count) + (count == 1 ? " edge is" : " edges are") + word));
    } else {
      EXPECT_THAT(all, testing::Not(HasSubstr(word)));
    }
  }
}

TEST(MeshImportModels, EachIsReadRightOrRefusedWithItsFault) {
  for (const ManifestEntry& entry : manifest()) {
    SCOPED_TRACE(entry.at("path"));
    const auto refusal = kRefusals.find(entry.at("path"));
    try {
      const ImportedMesh imported = importMesh(kModels / entry.at("path"), {});
      EXPECT_EQ(refusal, kRefusals.end()) << "should be refused";
      if (entry.at("path") == "nasty/stl_comments.stl") {  // The reference could not read it: one triangle.
        EXPECT_EQ(imported.mesh.triangles().size(), 1U);
        continue;
      }
      expectAsInManifest(entry, imported);
      expectEdgeWarnings(imported);
    } catch (const FileError& error) {
      ASSERT_NE(refusal, kRefusals.end()) << error.what();
      EXPECT_THAT(error.what(), HasSubstr(refusal->second));
      EXPECT_THAT(error.where(), HasSubstr(fs::path(entry.at("path")).filename().string()));
      EXPECT_FALSE(error.remedy().empty());
    }
  }
}

/// All files of the collections, whatever their format, and one that is always there.
std::vector<fs::path> filesToTry(const test::TemporaryFolder& folder) {
  std::vector<fs::path> files{folder.write("star.ply", test::plyBinary(test::starMesh(1, 1.0, 3, 0.4)))};
  if (!fs::exists(kModels)) return files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kModels)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  return files;
}

TEST(MeshImportModels, NoFileCrashesOrTakesMoreThanAFewTimesItsSize) {
  constexpr std::size_t kFixedBytes = std::size_t{32} << 20, kTimesSize = 12;
  constexpr unsigned kSeconds = 20;
  const test::TemporaryFolder folder;
  for (const fs::path& file : filesToTry(folder)) {
    const auto work = [&] {
      try {
        importMesh(file, {});
        return 0;
      } catch (const FileError& error) {
        return error.problem().find("not enough memory") == std::string::npos ? 0 : 1;
      }
    };
    const test::LimitedOutcome outcome =
        test::runLimited(work, kFixedBytes + kTimesSize * fs::file_size(file), kSeconds);
    EXPECT_TRUE(outcome.hasEnded) << file << " signal " << outcome.signal;
    EXPECT_EQ(outcome.result, 0) << file;
  }
}

}  // namespace
}  // namespace nearfit::mesh_import_models_test
