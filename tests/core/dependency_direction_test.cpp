#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/places.h"

namespace nearfit::dependency_direction_test {
namespace {

namespace fs = std::filesystem;

struct Include {
  fs::path file;
  std::string target;  ///< As written, without quotes or brackets.
};

std::vector<Include> readIncludesBelow(const std::string& folder) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> includes;
  for (const auto& entry : fs::recursive_directory_iterator(test::sourceFolder() / folder)) {
    const std::string extension = entry.path().extension();
    if (extension != ".h" && extension != ".cpp") continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      std::smatch match;
      // Few lines are worth the expression, which is slow under a sanitizer.
      if (line.find('#') != std::string::npos && std::regex_search(line, match, kInclude))
        includes.push_back({entry.path(), match[1]});
    }
  }
  return includes;
}

/// Reads each folder once: it is asked for by several tests.
const std::vector<Include>& includesBelow(const std::string& folder) {
  static std::map<std::string, std::vector<Include>> read;
  const auto at = read.find(folder);
  return at != read.end() ? at->second : read.emplace(folder, readIncludesBelow(folder)).first->second;
}

void expectNoInclude(const std::string& folder, const std::string& forbidden,
                     const std::string& onlyIn = "") {
  const std::regex pattern(forbidden);
  const std::vector<Include>& includes = includesBelow(folder);
  EXPECT_FALSE(includes.empty()) << folder << " has no sources";
  for (const Include& i : includes) {
    if (!onlyIn.empty() && i.file.extension() != onlyIn) continue;
    EXPECT_FALSE(std::regex_search(i.target, pattern)) << i.file << " includes " << i.target;
  }
}

constexpr const char* kQtOrVtk = "^(Q[A-Z]|vtk|Qt)";
constexpr const char* kLibusb = "libusb";

TEST(DependencyDirection, CoreKnowsNoQtNoVtkNoLibusbAndNoneOfTheOthers) {
  expectNoInclude("core", kQtOrVtk);
  expectNoInclude("core", kLibusb);
  expectNoInclude("core", "^(app|device|ui|tests)/");
}

TEST(DependencyDirection, DeviceKnowsCoreOnly) {
  expectNoInclude("device", kQtOrVtk);
  expectNoInclude("device", "^(app|ui|tests)/");
}

TEST(DependencyDirection, UiKnowsCoreOnly) {
  expectNoInclude("ui", kLibusb);
  expectNoInclude("ui", "^(app|device|tests)/");
}

TEST(DependencyDirection, AppKnowsNoLibusbAndNoTests) {
  expectNoInclude("app", kLibusb);
  expectNoInclude("app", "^tests/");
}

TEST(DependencyDirection, ForeignGeometryStaysInSourceFiles) {
  expectNoInclude("core", "^(OpenMesh|CGAL|openssl)/", ".h");
  // OpenCASCADE's headers carry its package in their names.
  expectNoInclude("core", "^(BRep|TopoDS|STEP|Standard_|gp_|TDF|XCAF|Poly_)", ".h");
  expectNoInclude("core", "^muParser", ".h");
  expectNoInclude("core", "^ompl/", ".h");
  for (const char* folder : {"app", "device", "ui"})
    expectNoInclude(folder, "^(OpenMesh/|CGAL/|openssl/|muParser|ompl/)");
}

using Folders = std::set<std::string>;

/// A row of the tables of folders in architecture.md.
struct FolderRow {
  std::string folder;
  Folders includes;  ///< Whole paths, of the same library.
};

/// Reads the rows "| `folder` | includes | what it holds |", where "includes" lists folders of the same library without
/// its name, separated by spaces; a dash stands for none.
std::vector<FolderRow> foldersOfThePage() {
  static const std::regex kRow(R"(^\| `((core|device|ui)/[a-z0-9_/]+)` \| ([^|]*) \|.*)");
  std::ifstream page(test::sourceFolder() / "resources" / "docs" / "architecture.md");
  std::vector<FolderRow> rows;
  for (std::string line; std::getline(page, line);) {
    std::smatch match;
    if (!std::regex_match(line, match, kRow)) continue;
    FolderRow row{match[1], {}};
    std::istringstream names(match[3]);
    for (std::string name; names >> name;)
      if (name != "-") row.includes.insert(match[2].str() + "/" + name);
    rows.push_back(row);
  }
  return rows;
}

/// Which folders of its own library each folder includes.
std::map<std::string, Folders> foldersOfTheCode() {
  std::map<std::string, Folders> folders;
  for (const std::string library : {"core", "device", "ui"}) {
    for (const Include& i : includesBelow(library)) {
      const std::string from = fs::relative(i.file.parent_path(), test::sourceFolder()).generic_string();
      Folders& includes = folders[from];
      const std::string to = fs::path(i.target).parent_path().generic_string();
      if (i.target.starts_with(library + "/") && to != from) includes.insert(to);
    }
  }
  return folders;
}

TEST(DependencyDirection, FoldersIncludeWhatTheArchitecturePageSays) {
  std::map<std::string, Folders> page;
  for (const FolderRow& row : foldersOfThePage())
    EXPECT_TRUE(page.emplace(row.folder, row.includes).second) << row.folder << " has two rows";
  const std::map<std::string, Folders> code = foldersOfTheCode();
  EXPECT_GT(code.size(), 40U);
  for (const auto& [folder, includes] : code) {
    const auto row = page.find(folder);
    if (row == page.end()) {
      ADD_FAILURE() << folder << " has no row in resources/docs/architecture.md";
      continue;
    }
    for (const std::string& other : includes)
      EXPECT_TRUE(row->second.contains(other)) << folder << " includes " << other << "; its row does not";
    for (const std::string& other : row->second)
      EXPECT_TRUE(includes.contains(other)) << folder << " does not include " << other << "; its row does";
  }
  for (const auto& row : page)
    EXPECT_TRUE(code.contains(row.first)) << row.first << " has a row but no sources";
}

TEST(DependencyDirection, AFolderIncludesOnlyThoseInRowsAboveItsOwn) {
  Folders above;
  for (const FolderRow& row : foldersOfThePage()) {
    for (const std::string& other : row.includes)
      EXPECT_TRUE(above.contains(other)) << row.folder << " includes " << other << ", which is not above it";
    above.insert(row.folder);
  }
}

TEST(DependencyDirection, PanelsToolsAndFilesOfTheWindowDoNotMeet) {
  const std::vector<std::string> layers{"ui/panels", "ui/tools", "ui/files"};
  const auto layerOf = [&](const std::string& folder) -> std::string {
    for (const std::string& layer : layers)
      if (folder == layer || folder.starts_with(layer + "/")) return layer;
    return {};
  };
  for (const auto& [folder, includes] : foldersOfTheCode()) {
    if (layerOf(folder).empty()) continue;
    for (const std::string& other : includes)
      EXPECT_TRUE(layerOf(other).empty() || layerOf(other) == layerOf(folder))
          << folder << " includes " << other;
  }
}

TEST(DependencyDirection, IncludesOfOursAreRooted) {
  for (const char* folder : {"app", "core", "device", "ui"})
    expectNoInclude(folder, "^\\.\\.?/");
}

}  // namespace
}  // namespace nearfit::dependency_direction_test
