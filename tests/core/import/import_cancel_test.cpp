#include <chrono>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/import/mesh_import.h"
#include "core/scene/part_geometry.h"
#include "tests/support/mesh_files.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::import_cancel_test {
namespace {

using Clock = std::chrono::steady_clock;

/// What a cancel button goes through: how often work asks whether to go on, and for how long it did not.
struct Asked {
  int count = 0;
  double longest = 0.0;  ///< [s]; told, not judged: the machine may have been busy.
  Clock::time_point last = Clock::now();

  ProgressCallback callback(int stopAt = -1) {
    return [this, stopAt](double) {
      const auto now = Clock::now();
      longest = std::max(longest, std::chrono::duration<double>(now - last).count());
      last = now;
      return ++count != stopAt;
    };
  }
};

class ImportCancel : public testing::TestWithParam<const char*> {
 protected:
  /// A million triangles.
  static const TriangleMesh& mesh() {
    static const TriangleMesh million = test::uvSphereMesh(0.05, 1000, 501);
    return million;
  }
  static std::string bytesOf(const std::string& format) {
    if (format == "stl") return test::stlBinary(mesh());
    if (format == "obj") return test::objText(mesh());
    if (format == "ply") return test::plyBinary(mesh());
    return test::offText(mesh());
  }

  test::TemporaryFolder folder_;
};

TEST_P(ImportCancel, AMillionTrianglesAskOftenAndStopWhenTold) {
  const std::string format = GetParam();
  const auto file = folder_.write("million." + format, bytesOf(format));
  Asked whole;
  const ImportedMesh imported = importMesh(file, {}, whole.callback());
  EXPECT_GT(imported.mesh.triangles().size(), 990'000U);
  EXPECT_GE(whole.count, 20);
  RecordProperty("asked", whole.count);
  std::printf("%s: asked %d times, longest pause %.3f s\n", format.c_str(), whole.count, whole.longest);
  for (const double share : {0.01, 0.5, 0.99}) {
    Asked stopped;
    const int stopAt = std::max(1, static_cast<int>(share * whole.count));
    EXPECT_THROW(importMesh(file, {}, stopped.callback(stopAt)), Cancelled);
    EXPECT_EQ(stopped.count, stopAt) << "it went on after it was told to stop";
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, ImportCancel, testing::Values("stl", "obj", "ply", "off"));

TEST(HierarchyCancel, AMillionTrianglesAskOftenAndStopWhenTold) {
  const TriangleMesh mesh = test::uvSphereMesh(0.05, 1000, 501);
  HierarchyOnDemand hierarchy;
  Asked stopped;
  constexpr int kStopAt = 40;
  EXPECT_THROW(hierarchy.get(mesh, stopped.callback(kStopAt)), Cancelled);
  Asked whole;
  hierarchy.get(mesh, whole.callback());
  EXPECT_GE(whole.count, 100);
  std::printf("hierarchy: asked %d times, longest pause %.3f s\n", whole.count, whole.longest);
}

}  // namespace
}  // namespace nearfit::import_cancel_test
