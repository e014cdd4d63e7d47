#pragma once

#include <string>

#include <gtest/gtest.h>

#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/run_process.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::test {

/// A scene of a plate and, 1 m above it, a cube that is the moving part, in metres.
class PlateAndCube : public ::testing::Test {
 protected:
  PlateAndCube() {
    const std::string plate = folder_.write("plate.obj", objText(boxMesh({4, 4, 1}))).string();
    const std::string cube = folder_.write("cube.obj", objText(boxMesh({1, 1, 1}))).string();
    const auto made = runCli({"scene", "new", scene_, "--unit", "m", "--part", "Plate=" + plate, "--part",
                              "Cube=" + cube + "@0,0,2,1,0,0,0", "--moving", "Cube"});
    EXPECT_EQ(made.exitCode, 0) << made.err;
  }
  std::string path(const char* name) { return (folder_.path() / name).string(); }

  TemporaryFolder folder_;
  std::string scene_ = path("fit.nearfit");
};

}  // namespace nearfit::test
