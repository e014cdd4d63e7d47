#include <chrono>
#include <cstdint>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/import/mesh_import.h"
#include "core/scene/part_geometry.h"
#include "tests/support/mesh_files.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trial_share.h"

namespace nearfit::import_cancel_test {
namespace {

using Clock = std::chrono::steady_clock;

/// A million triangles; sanitized builds take a share of them.
TriangleMesh largeMesh() {
  return test::uvSphereMesh(0.05, static_cast<std::uint32_t>(1000 / test::kTrialShare), 501);
}

/// What a cancel button goes through: how often work asks whether to go on, and for how long it did not.
struct Asked {
  std::size_t count = 0;
  double longest = 0.0;  ///< [s]; told, not judged: the machine may have been busy.
  Clock::time_point last = Clock::now();

  /// @param stopAt  Says stop when it is asked for this time; 0: never.
  ProgressCallback callback(std::size_t stopAt = 0) {
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
  static const TriangleMesh& mesh() {
    static const TriangleMesh large = largeMesh();
    return large;
  }
  static std::string bytesOf(const std::string& format) {
    if (format == "stl") return test::stlBinary(mesh());
    if (format == "obj") return test::objText(mesh());
    if (format == "ply") return test::plyBinary(mesh());
    return test::offText(mesh());
  }

  test::TemporaryFolder folder_;
};

TEST_P(ImportCancel, ManyTrianglesAskOftenAndStopWhenTold) {
  const std::string format = GetParam();
  const auto file = folder_.write("large." + format, bytesOf(format));
  Asked whole;
  const ImportedMesh imported = importMesh(file, {}, whole.callback());
  EXPECT_GT(imported.mesh.triangles().size(), 990'000U / test::kTrialShare);
  EXPECT_GE(whole.count, 20U / test::kTrialShare);
  RecordProperty("asked", std::to_string(whole.count));
  std::printf("%s: asked %zu times, longest pause %.3f s\n", format.c_str(), whole.count, whole.longest);
  for (const double share : {0.01, 0.5, 0.99}) {
    Asked stopped;
    const auto stopAt =
        std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(whole.count)));
    EXPECT_THROW(importMesh(file, {}, stopped.callback(stopAt)), Cancelled);
    EXPECT_EQ(stopped.count, stopAt) << "it went on after it was told to stop";
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, ImportCancel, testing::Values("stl", "obj", "ply", "off"));

TEST(HierarchyCancel, ManyTrianglesAskOftenAndStopWhenTold) {
  const TriangleMesh mesh = largeMesh();
  HierarchyOnDemand hierarchy;
  Asked stopped;
  constexpr std::size_t kStopAt = 40 / test::kTrialShare;
  EXPECT_THROW(hierarchy.get(mesh, stopped.callback(kStopAt)), Cancelled);
  Asked whole;
  hierarchy.get(mesh, whole.callback());
  EXPECT_GE(whole.count, 100U / test::kTrialShare);
  std::printf("hierarchy: asked %zu times, longest pause %.3f s\n", whole.count, whole.longest);
}

}  // namespace
}  // namespace nearfit::import_cancel_test
