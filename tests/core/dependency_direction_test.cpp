#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace nearfit::dependency_direction_test {
namespace {

namespace fs = std::filesystem;

struct Include {
  fs::path file;
  std::string target;  ///< As written, without quotes or brackets.
};

std::vector<Include> includesBelow(const std::string& folder) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> includes;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(NEARFIT_SOURCE_DIR) / folder)) {
    const std::string extension = entry.path().extension();
    if (extension != ".h" && extension != ".cpp") continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      std::smatch match;
      if (std::regex_search(line, match, kInclude)) includes.push_back({entry.path(), match[1]});
    }
  }
  return includes;
}

void expectNoInclude(const std::string& folder, const std::string& forbidden,
                     const std::string& onlyIn = "") {
  const std::regex pattern(forbidden);
  const std::vector<Include> includes = includesBelow(folder);
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
  for (const char* folder : {"app", "device", "ui"})
    expectNoInclude(folder, "^(OpenMesh/|CGAL/|openssl/|muParser)");
}

TEST(DependencyDirection, IncludesOfOursAreRooted) {
  for (const char* folder : {"app", "core", "device", "ui"})
    expectNoInclude(folder, "^\\.\\.?/");
}

}  // namespace
}  // namespace nearfit::dependency_direction_test
