#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/scene/scene_file.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/run_process.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::test {

inline std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');)
    cells.push_back(cell);
  return cells;
}

/// A recording by columns.
class Record {
 public:
  explicit Record(const std::filesystem::path& file) {
    const std::vector<std::string> lines = linesOf(readBytes(file));
    header_ = lines.at(0);
    names_ = cellsOf(header_);
    for (std::size_t i = 1; i < lines.size(); ++i)
      addRow(lines[i]);
  }
  const std::string& header() const { return header_; }
  std::size_t rows() const { return rows_; }
  const std::vector<double>& operator[](const std::string& name) const { return columns_.at(name); }

 private:
  void addRow(const std::string& line) {
    const std::vector<std::string> cells = cellsOf(line);
    if (cells.size() != names_.size()) throw std::runtime_error("a row is short or long: " + line);
    for (std::size_t i = 0; i < cells.size(); ++i)
      columns_[names_[i]].push_back(std::stod(cells[i]));
    ++rows_;
  }

  std::string header_;
  std::vector<std::string> names_;
  std::map<std::string, std::vector<double>> columns_;
  std::size_t rows_ = 0;
};

/// A cone, tip down, over a floor with its top in z = 0, and a path on which the tip sinks.
class PlaceFixture : public ::testing::Test {
 protected:
  static constexpr int kTicks = 400;

  PlaceFixture() {
    const RigidTransform upsideDown{glm::dquat(0.0, 1.0, 0.0, 0.0), {0.0, 0.0, 1.0}};
    folder_.write("cone.obj", objText(transformed(coneMesh(0.2, 1.0, 12), 1.0, upsideDown)));
    folder_.write("floor.obj", objText(boxMesh({2.0, 2.0, 1.0}, {0.0, 0.0, -0.5})));
    options_.workingFolder = folder_.path();
    const ProcessResult made = runCli(
        {"scene", "new", "fit.nearfit", "--unit", "m", "--part", "Floor=floor.obj", "--part",
         "Cone=cone.obj@0.3,0.1,0.5,1,0,0,0", "--cutoff", "0.1", "--stiffness", "50", "--mode", "spring"},
        options_);
    EXPECT_EQ(made.exitCode, 0) << made.err;
    folder_.write("path.csv", pathText(kTicks));
  }

  /// Height of the tip in the i-th tick.
  static double heightAt(int i) { return 0.12 - 0.1 * (i + 0.5) / kTicks; }
  static std::string pathText(int ticks) {
    std::string text = "# sinking\ntx,ty,tz,qw,qx,qy,qz\n";
    for (int i = 0; i < ticks; ++i)
      text += fmt::format("0.3,0.1,{},1,0,0,0\n", heightAt(i % kTicks));
    return text;
  }
  ProcessResult place(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"place", "fit.nearfit"});
    return runCli(arguments, options_);
  }
  ProcessResult placeCone(std::vector<std::string> more) const {
    more.insert(more.begin(), {"--part", "Cone", "--path", "path.csv"});
    return place(more);
  }
  std::filesystem::path file(const std::string& name) const { return folder_.path() / name; }
  void changePart(const std::string& name, const std::function<void(Part&)>& change) const {
    Scene scene = readSceneFile(file("fit.nearfit"));
    Part part = *scene.findByName(name);
    change(part);
    scene.replace(part);
    writeSceneFile(scene, file("fit.nearfit"));
  }

  TemporaryFolder folder_;
  ProcessOptions options_;
};

}  // namespace nearfit::test
