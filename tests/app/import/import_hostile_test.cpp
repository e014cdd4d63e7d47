// STEP files made to take all memory, to overflow a stack or never to end; other formats likewise; and the sandbox.
// Each is refused with a message, by the importer or because its process ended, within limits that the system enforces.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"
#include "tests/app/import/import_fixture.h"
#include "tests/support/places.h"
#include "tests/support/run_process.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::import_hostile_test {
namespace {

namespace fs = std::filesystem;
using test::imported;
using test::importModel;
using test::sharedModel;
using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

#ifdef NEARFIT_SANITIZED
// They reserve terabytes, and make everything some ten times as slow.
constexpr bool kIsMemoryLimited = false;
constexpr ::rlim_t kMaxCpuSeconds = 100;
#else
constexpr bool kIsMemoryLimited = true;
constexpr ::rlim_t kMaxCpuSeconds = 10;
#endif
constexpr ::rlim_t kMaxMemory = ::rlim_t{2} << 30;
/// From this size on [bytes] the importer allows itself more than kMaxMemory, and may not end for want of it here.
constexpr std::uintmax_t kLargeFile = 1'000'000;

/// How an import within limits ended.
struct LimitedImport {
  bool isRefused = false;
  std::string where, problem, remedy;
  Aabb box;  ///< Around all that was imported.
  std::size_t shapes = 0, faces = 0;
  long maxResidentKiB = 0;  ///< Memory of the importer.
};

void limitThisProcess(__rlimit_resource resource, ::rlim_t value) {
  // Programs that it starts cannot raise them: the importer lowers its limits to those that it finds.
  const ::rlimit both{value, value};
  if (::setrlimit(resource, &both) != 0) ::_exit(1);
}

nlohmann::json toldOf(const fs::path& file) {
  try {
    const CadDocument document = imported(file);
    const Aabb box = test::boxOf(document);
    nlohmann::json told = {{"shapes", document.shapes.size()}, {"faces", 0}};
    for (const CadShape& shape : document.shapes)
      told["faces"] = told["faces"].get<std::size_t>() + shape.surfaces.faces.size();
    told["box"] = {box.lower.x, box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z};
    return told;
  } catch (const FileError& error) {
    return {{"where", error.where()}, {"problem", error.problem()}, {"remedy", error.remedy()}};
  } catch (const std::exception& error) {
    return {{"error", error.what()}};
  }
}

/// Imports a file in a copy of this process that may take no more than kMaxCpuSeconds of processor time and kMaxMemory,
/// and nor may the importer that it starts.
LimitedImport importedWithinLimits(const fs::path& file) {
  const TemporaryFolder folder;
  const fs::path report = folder.path() / "report.json";
  const ::pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) {
    limitThisProcess(RLIMIT_CORE, 0);
    limitThisProcess(RLIMIT_CPU, kMaxCpuSeconds);
    if (kIsMemoryLimited) limitThisProcess(RLIMIT_DATA, kMaxMemory);
    nlohmann::json told = toldOf(file);
    ::rusage usage{};
    ::getrusage(RUSAGE_CHILDREN, &usage);
    told["maxResidentKiB"] = usage.ru_maxrss;
    std::ofstream(report) << told.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)
                          << std::flush;
    ::_exit(0);
  }
  int status = 0;
  if (::waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error("the import's parent ended early");
  const nlohmann::json told = nlohmann::json::parse(test::readBytes(report));
  EXPECT_FALSE(told.contains("error")) << told["error"];
  LimitedImport result;
  result.isRefused = told.contains("problem");
  result.where = told.value("where", "");
  result.problem = told.value("problem", "");
  result.remedy = told.value("remedy", "");
  result.shapes = told.value("shapes", std::size_t{0});
  result.faces = told.value("faces", std::size_t{0});
  result.maxResidentKiB = told.value("maxResidentKiB", 0L);
  if (told.contains("box")) {
    // JSON has no infinity: it writes null.
    const auto number = [&](int i) {
      return told["box"][i].is_number() ? told["box"][i].get<double>() : NAN;
    };
    result.box.lower = {number(0), number(1), number(2)};
    result.box.upper = {number(3), number(4), number(5)};
  }
  return result;
}

/// Imports a file within limits, and holds what came of it against them.
LimitedImport checkedImport(const fs::path& file) {
  LimitedImport result = importedWithinLimits(file);
  // Ended at the limit of time, softly and hard.
  EXPECT_THAT(result.problem, AllOf(Not(HasSubstr("processor time")), Not(HasSubstr("was killed")))) << file;
  // A limit of memory is what ends a small file within it; a large one would be allowed more where nobody limits it.
  if (fs::file_size(file) > kLargeFile) {
    EXPECT_THAT(result.problem, Not(HasSubstr("memory"))) << file;
  }
  if (kIsMemoryLimited) {
    EXPECT_LE(result.maxResidentKiB, static_cast<long>(kMaxMemory >> 10)) << file;
  }
  if (result.isRefused) {
    EXPECT_THAT(result.where, HasSubstr(file.filename().string()));
    EXPECT_FALSE(result.remedy.empty()) << result.problem;
  }
  return result;
}

/// Frame of a STEP file, with a unit and a placement (#12).
std::string step(const std::string& entities) {
  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('a','2026-01-01T00:00:00',(''),(''"
         "),'','','');\n"
         "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n"
         "#1=APPLICATION_CONTEXT('x');\n#2=PRODUCT_CONTEXT('',#1,'mechanical');\n"
         "#3=PRODUCT_DEFINITION_CONTEXT('',#1,'design');\n#4=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,."
         "METRE.));\n"
         "#5=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));\n#6=(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)"
         "SOLID_ANGLE_UNIT());\n"
         "#7=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-6),#4,'','');\n"
         "#8=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#7))"
         "GLOBAL_UNIT_ASSIGNED_CONTEXT((#4,#5,#6))REPRESENTATION_CONTEXT('',''));\n"
         "#9=CARTESIAN_POINT('',(0.,0.,0.));\n#10=DIRECTION('',(0.,0.,1.));\n#11=DIRECTION('',(1.,0.,0.));\n"
         "#12=AXIS2_PLACEMENT_3D('',#9,#10,#11);\n" +
         entities + "ENDSEC;\nEND-ISO-10303-21;\n";
}

/// Product `i` with a representation of these items, #1004 + 100 i.
std::string product(int i, const std::string& items = "#12",
                    const std::string& kind = "SHAPE_REPRESENTATION") {
  const int b = 1000 + 100 * i;
  return fmt::format(
      "#{}=PRODUCT('p{}','p{}','',(#2));\n#{}=PRODUCT_DEFINITION_FORMATION('','',#{});\n#{}=PRODUCT_"
      "DEFINITION('','',#{},#3);\n"
      "#{}=PRODUCT_DEFINITION_SHAPE('','',#{});\n#{}={}('',({}),#8);\n#{}=SHAPE_DEFINITION_REPRESENTATION(#{}"
      ",#{});\n",
      b, i, i, b + 1, b, b + 2, b + 1, b + 3, b + 2, b + 4, kind, items, b + 5, b + 3, b + 4);
}

/// Places product `child` in product `parent`, for the `k`-th time.
std::string placed(int parent, int child, int k) {
  const int b = 1010 + 100 * parent + 10 * k, p = 1000 + 100 * parent, c = 1000 + 100 * child;
  return fmt::format(
      "#{}=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','','',#{},#{},$);\n#{}=PRODUCT_DEFINITION_SHAPE('','',#{});\n"
      "#{}=ITEM_DEFINED_TRANSFORMATION('','',#12,#12);\n#{}=(REPRESENTATION_RELATIONSHIP('','',#{},#{})"
      "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{})SHAPE_REPRESENTATION_RELATIONSHIP());\n"
      "#{}=CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{},#{});\n",
      b, p + 2, c + 2, b + 1, b, b + 2, b + 3, c + 4, p + 4, b + 2, b + 4, b + 3, b + 1);
}

std::string repeated(int from, int to, const std::function<std::string(int)>& text) {
  std::string all;
  for (int i = from; i < to; ++i)
    all += text(i);
  return all;
}

class ImportHostile : public testing::Test {
 protected:
  /// The refusal of a file of these bytes, within limits.
  LimitedImport refusal(const std::string& name, const std::string& content) const {
    LimitedImport result = checkedImport(folder_.write(name, content));
    EXPECT_TRUE(result.isRefused) << name << " was imported";
    return result;
  }
  std::string problem(const std::string& entities) const { return refusal("x.step", step(entities)).problem; }

  TemporaryFolder folder_;
};

TEST_F(ImportHostile, ParenthesesNestedAMillionDeepAreRefused) {
  constexpr int kMillion = 1'000'000;
  EXPECT_THAT(problem("#20=A(" + std::string(kMillion, '(') + std::string(kMillion, ')') + ");\n"),
              HasSubstr("nested"));
  std::string types;
  for (int i = 0; i < kMillion; ++i)
    types += "B(";
  EXPECT_THAT(problem("#20=A(" + types + std::string(kMillion, ')') + ");\n"), HasSubstr("nested"));
}

TEST_F(ImportHostile, EntitiesChainedAMillionDeepAreRefused) {
  constexpr int kFirst = 100'000, kLast = 1'100'000;
  const std::string chain = repeated(kFirst, kLast, [](int i) {
    return fmt::format("#{}=OFFSET_CURVE_3D('',#{},1.,.F.,#10);\n", i, i + 1);
  });
  const std::string last = fmt::format("#{}=LINE('',#9,#10);\n", kLast);
  EXPECT_THAT(problem(chain + last + product(0, fmt::format("#{}", kFirst))), HasSubstr("nested"));
}

TEST_F(ImportHostile, ChainsOfEntitiesAreFoundInAnyOrderAndInCircles) {
  constexpr int kFirst = 100'000, kLast = 150'000;
  // From the last to the first: nothing that is begun leads far.
  const std::string backwards = repeated(0, kLast - kFirst, [](int i) {
    return fmt::format("#{}=OFFSET_CURVE_3D('',#{},1.,.F.,#10);\n", kLast - i, kLast - i + 1);
  });
  EXPECT_THAT(problem(backwards), HasSubstr("nested"));
  const std::string circle = repeated(kFirst, kLast, [](int i) {
    return fmt::format("#{}=OFFSET_CURVE_3D('',#{},1.,.F.,#10);\n", i, i + 1 < kLast ? i + 1 : kFirst);
  });
  EXPECT_THAT(problem(circle), HasSubstr("nested"));
}

TEST_F(ImportHostile, AThousandEntitiesInAChainAreNoReasonToRefuse) {
  const std::string chain = repeated(900'000, 901'000, [](int i) {
    return fmt::format("#{}=OFFSET_CURVE_3D('',#{},1.,.F.,#901003);\n", i, i + 1);
  });
  std::string bracket = test::readBytes(importModel("bracket.step"));
  bracket.replace(bracket.find("ENDSEC;\nEND-ISO"), 0,
                  chain +
                      "#901000=LINE('',#901001,#901002);\n#901001=CARTESIAN_POINT('',(0.,0.,0.));\n"
                      "#901002=VECTOR('',#901003,1.);\n#901003=DIRECTION('',(0.,0.,1.));\n");
  EXPECT_EQ(checkedImport(folder_.write("chain.step", bracket)).shapes, 1U);
}

TEST_F(ImportHostile, AnAssemblyThatContainsItselfIsRefused) {
  EXPECT_THAT(problem(product(0) + product(1) + placed(0, 1, 0) + placed(1, 0, 0)),
              HasSubstr("contains itself"));
  EXPECT_THAT(problem(product(0) + placed(0, 0, 0)), HasSubstr("contains itself"));
  EXPECT_THAT(problem("#500=REPRESENTATION_MAP(#12,#1004);\n#501=MAPPED_ITEM('',#500,#12);\n" +
                      product(0, "#12,#501")),
              HasSubstr("contains itself"));
}

TEST_F(ImportHostile, CurvesThatAreBasedOnEachOtherAreRefused) {
  problem(
      "#900=TRIMMED_CURVE('',#901,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(1.)),.T.,.PARAMETER.);\n"
      "#901=TRIMMED_CURVE('',#900,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(1.)),.T.,.PARAMETER.);\n"
      "#902=GEOMETRIC_CURVE_SET('',(#900));\n" +
      product(0, "#902", "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION"));
}

TEST_F(ImportHostile, SurfacesThatAreBasedOnEachOtherAreRefused) {
  problem(
      "#900=OFFSET_SURFACE('',#901,1.,.F.);\n#901=OFFSET_SURFACE('',#900,1.,.F.);\n"
      "#902=ADVANCED_FACE('',(),#900,.T.);\n#903=OPEN_SHELL('',(#902));\n"
      "#904=SHELL_BASED_SURFACE_MODEL('',(#903));\n" +
      product(0, "#12,#904", "MANIFOLD_SURFACE_SHAPE_REPRESENTATION"));
}

TEST_F(ImportHostile, ABillionInstancesByNestingAreRefused) {
  std::string assembly;
  for (int i = 0; i < 30; ++i)
    assembly += product(i) + placed(i, i + 1, 0) + placed(i, i + 1, 1);
  EXPECT_THAT(problem(assembly + product(30)), HasSubstr("more than 100000 instances"));
}

TEST_F(ImportHostile, ABillionMappedItemsAreRefused) {
  const std::string maps = repeated(0, 31, [](int i) {
    return fmt::format(
        "#{0}=REPRESENTATION_MAP(#12,#{1});\n#{2}=MAPPED_ITEM('',#{0},#12);\n#{3}=SHAPE_REPRESENTATION('',(#"
        "12,#{2},#{2}),#8);\n",
        500 + 3 * i, 5000 + i + 1, 501 + 3 * i, 5000 + i);
  });
  EXPECT_THAT(problem(maps + "#5031=SHAPE_REPRESENTATION('',(#12),#8);\n" + product(0, "#12,#501")),
              HasSubstr("instances"));
}

TEST_F(ImportHostile, AssembliesNestedTooDeepAreRefused) {
  EXPECT_THAT(
      problem(repeated(0, 300, [](int i) { return product(i) + placed(i, i + 1, 0); }) + product(300)),
      HasSubstr("nested"));
}

TEST_F(ImportHostile, NumbersBeyondRangeAreRefusedWithTheirLine) {
  EXPECT_THAT(problem("#20=CARTESIAN_POINT('',(0.,1.E400,0.));\n"), HasSubstr("beyond range"));
  EXPECT_THAT(problem("#20=CARTESIAN_POINT('',(0.," + std::string(400, '9') + ".,0.));\n"),
              HasSubstr("beyond range"));
  EXPECT_THAT(problem("#20=A(99999999999);\n"), HasSubstr("beyond range"));
  EXPECT_THAT(problem("#99999999999=A(1);\n"), HasSubstr("beyond range"));
  EXPECT_THAT(refusal("line.step", "ISO-10303-21;\nDATA;\n\n#1=A(1.E999);\n").where,
              HasSubstr("line.step:4"));
}

TEST_F(ImportHostile, ARealBelowRangeIsNoReasonToRefuse) {
  std::string bracket = test::readBytes(importModel("bracket.step"));
  bracket.replace(bracket.find("ENDSEC;\nEND-ISO"), 0, "#900000=CARTESIAN_POINT('',(1.E-400,2.E+300,0.));\n");
  EXPECT_EQ(imported(folder_.write("tiny.step", bracket)).shapes.size(), 1U);
}

TEST_F(ImportHostile, SplinesOfImpossibleCountsAreRefused) {
  const auto spline = [](const std::string& degree, const std::string& multiplicities) {
    return "#900=B_SPLINE_CURVE_WITH_KNOTS(''," + degree + ",(#9,#9,#9,#9),.UNSPECIFIED.,.F.,.F.,(" +
           multiplicities + "),(0.,1.),.UNSPECIFIED.);\n#901=GEOMETRIC_CURVE_SET('',(#900));\n" +
           product(0, "#901", "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION");
  };
  problem(spline("3", "2000000000,2000000000"));
  problem(spline("2000000000", "4,4"));
  problem(spline("-1", "0,0"));
}

TEST_F(ImportHostile, WhatIsCutOffIsSaidToBe) {
  const std::string bracket = test::readBytes(importModel("bracket.step"));
  for (std::size_t k = 1; k < 8; ++k)
    refusal("cut.step", bracket.substr(0, bracket.size() * k / 8));
}

TEST_F(ImportHostile, ACommentOrATextWithoutEndIsRefused) {
  EXPECT_THAT(problem("#20=A('no end);\n"), HasSubstr("no end"));
  EXPECT_THAT(problem("/* no end\n"), HasSubstr("no end"));
}

TEST_F(ImportHostile, FlippedBytesOfAFileNeverReachTheProgram) {
  const std::string bracket = test::readBytes(importModel("two_solids.step"));
  for (std::size_t k = 0; k < 24; ++k) {
    std::string damaged = bracket;
    for (std::size_t at = 1200 + 37 * k; at < damaged.size(); at += 1999)
      damaged[at] = static_cast<char>('0' + (at + k) % 10);
    try {
      imported(folder_.write("damaged.step", damaged));
    } catch (const FileError&) {
    }
  }
}

TEST_F(ImportHostile, GltfNodesInACycleOrByTheBillionAreRefused) {
  const auto gltf = [](const std::string& nodes) {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes + "]}";
  };
  EXPECT_THAT(refusal("x.gltf", gltf(R"({"children":[1]},{"children":[0]})")).problem,
              HasSubstr("contains itself"));
  std::string doubling;
  for (int i = 0; i < 40; ++i)
    doubling += fmt::format(R"({{"children":[{0},{0}]}},)", i + 1);
  EXPECT_THAT(refusal("x.gltf", gltf(doubling + "{}")).problem, HasSubstr("instances"));
  EXPECT_THAT(refusal("x.gltf", gltf(R"({"children":[7]})")).problem, HasSubstr("does not exist"));
}

TEST_F(ImportHostile, GltfNestedDeepOrNamingOtherFilesIsRefused) {
  EXPECT_THAT(
      refusal("x.gltf", R"({"a":)" + std::string(1'000'000, '[') + std::string(1'000'000, ']') + "}").problem,
      HasSubstr("nested"));
  for (const char* uri : {"../secret.bin", "/etc/passwd", "file:///etc/passwd"})
    EXPECT_THAT(
        refusal(
            "x.gltf",
            fmt::format(R"({{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":4,"uri":"{}"}}]}})", uri))
            .problem,
        HasSubstr("outside of its folder"));
}

TEST_F(ImportHostile, UrdfNestedDeepOrWithoutARootIsRefused) {
  std::string nested = "<robot name='r'>";
  for (int i = 0; i < 200'000; ++i)
    nested += "<a>";
  EXPECT_THAT(refusal("x.urdf", nested).problem, HasSubstr("nested"));
  refusal("x.urdf",
          "<robot name='r'><link name='a'/><link name='b'/>"
          "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
          "<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint></robot>");
}

// The message named a node of a document that nobody sees, and no file. Found when the fuzzer of imports was written.
TEST_F(ImportHostile, APlaceBeyondRangeIsRefusedWithTheFile) {
  EXPECT_THAT(refusal("x.urdf",
                      "<robot name='r'><link name='a'/><link name='b'><visual><geometry><box size='1 1 1'/>"
                      "</geometry></visual></link><joint name='j' type='fixed'><origin xyz='1e13 0 0'/>"
                      "<parent link='a'/><child link='b'/></joint></robot>")
                  .problem,
              HasSubstr("out of range (node 1: its place is out of range)"));
}

TEST_F(ImportHostile, AFileThatUnpacksToMoreThanAGigabyteIsRefused) {
  const fs::path big = folder_.path() / "x.step";
  // A hole of the file system: gzip makes some megabytes of it.
  {
    std::ofstream(big).put('I');
  }
  fs::resize_file(big, (std::uintmax_t{1} << 30) + (std::uintmax_t{64} << 20));
  ASSERT_EQ(test::runProcess({"gzip", "-1", big.string()}).exitCode, 0);
  EXPECT_THAT(checkedImport(big.string() + ".gz").problem, HasSubstr("too large when unpacked"));
}

TEST_F(ImportHostile, NastyFilesBesideTheRepositoryAreReadRightOrRefused) {
  const fs::path nasty = sharedModel("nasty");
  if (!fs::exists(nasty)) return;
  std::map<std::string, LimitedImport> imports;
  for (const fs::directory_entry& entry : fs::directory_iterator(nasty)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".stp" || extension == ".step" || extension == ".gltf" || extension == ".glb")
      imports.emplace(entry.path().filename().string(), checkedImport(entry.path()));
  }
  EXPECT_GE(imports.size(), 4U);
  for (const auto& [name, result] : imports) {
    if (result.isRefused) continue;
    EXPECT_GT(result.shapes, 0U) << name;
    for (int k = 0; k < 3; ++k)
      EXPECT_TRUE(std::isfinite(result.box.lower[k]) && std::isfinite(result.box.upper[k])) << name;
  }
  EXPECT_THAT(imports.at("gltf_recursive_nodes.gltf").problem, HasSubstr("contains itself"));
  // Four faces at one edge are no solid, but can be felt. Its box is that of the list beside it, in millimetres.
  const LimitedImport& nonManifold = imports.at("step_nonmanifold_edge.stp");
  if (nonManifold.isRefused) return;
  EXPECT_EQ(nonManifold.faces, 4U);
  constexpr double kTolerance = 0.05e-3;
  EXPECT_LE(glm::distance(nonManifold.box.lower, glm::dvec3(0, 5.75452, 1.75) * 1e-3), kTolerance);
  EXPECT_LE(glm::distance(nonManifold.box.upper, glm::dvec3(6.39105, 8.6, 12.25) * 1e-3), kTolerance);
}

TEST_F(ImportHostile, CancelEndsTheImport) {
  int calls = 0;
  EXPECT_THROW(imported(importModel("bracket.step"), {}, [&](double) { return ++calls < 2; }), Cancelled);
}

TEST_F(ImportHostile, ProgressGrowsToItsEnd) {
  double last = 0.0;
  imported(importModel("bracket.step"), {}, [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  });
  EXPECT_EQ(last, 1.0);
}

TEST(ImportSandbox, MemoryAndTimeForASmallFileAreLimitedAsTheDocumentationSays) {
  const std::string tried = test::runProcess({test::builtPath("nearfit-import"), "--try-sandbox"}).out;
  EXPECT_THAT(tried, HasSubstr("processor time: at most 120 s"));
  if (kIsMemoryLimited) {
    EXPECT_THAT(tried, HasSubstr("memory: at most 2048 MiB"));
  }
}

TEST(ImportSandbox, NothingButReadingIsAllowedWhereTheKernelCanForbidIt) {
  const std::string version = test::runProcess({test::builtPath("nearfit-import"), "--version"}).out;
  const std::string tried = test::runProcess({test::builtPath("nearfit-import"), "--try-sandbox"}).out;
  EXPECT_THAT(version, HasSubstr("sandbox:"));
  if (version.find("sanitizers") != std::string::npos) return;
  const bool hasSeccomp =
      version.find(" seccomp") != std::string::npos && version.find("no seccomp") == std::string::npos;
  if (hasSeccomp) {
    for (const char* what :
         {"network", "local sockets", "writing files", "signals to others", "processes", "programs"})
      EXPECT_THAT(tried, HasSubstr(std::string(what) + ": refused"));
    EXPECT_THAT(tried, HasSubstr("threads: allowed"));
  }
  if (version.find("no Landlock") != std::string::npos) return;
  EXPECT_THAT(tried, HasSubstr("reading other files: refused"));
}

}  // namespace
}  // namespace nearfit::import_hostile_test
