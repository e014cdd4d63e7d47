#include <chrono>
#include <cmath>
#include <csignal>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/haptics/wrench_conditioner.h"
#include "core/scene/scene_file.h"
#include "core/servo/motion_recording.h"
#include "tests/app/cli/place_fixture.h"
#include "tests/support/eventually.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/places.h"
#include "tests/support/run_process.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::test::place_command_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

using PlaceCommand = PlaceFixture;

void expectTheFallOnTheFloor(const Record& record, int ticks, const std::function<double(int)>& heightAt) {
  ASSERT_EQ(record.rows(), static_cast<std::size_t>(ticks));
  for (int i = 0; i < ticks; ++i) {
    const auto row = static_cast<std::size_t>(i);
    const double height = heightAt(i);
    for (const char* const pose : {"handle", "proxy"}) {
      const std::string name(pose);
      ASSERT_EQ(record[name + "_tx"][row], 0.3);
      ASSERT_EQ(record[name + "_tz"][row], height);
      ASSERT_EQ(record[name + "_qw"][row], 1.0);
    }
    const bool isFelt = height < 0.1;
    ASSERT_EQ(record["lmds"][row], isFelt ? 1.0 : 0.0) << i;
    const double full = isFelt ? 50.0 * (0.1 - height) : 0.0;
    // What is felt is faded in, by the time that really passed: ticks may come late.
    constexpr double kLate = 0.05;
    if (record["t_s"][row] < WrenchConditioner::kRampTime + kLate) {
      ASSERT_GE(record["force_z"][row], 0.0) << i;
      ASSERT_LE(record["force_z"][row], full + 1e-9) << i;
    } else {
      ASSERT_NEAR(record["force_z"][row], full, 1e-9) << i;
    }
    ASSERT_NEAR(record["force_x"][row], 0.0, 1e-9);
    // The centre of mass is right above the tip.
    ASSERT_NEAR(record["torque_y"][row], 0.0, 1e-9);
    const double distance = record["distance"][row];
    ASSERT_TRUE(isFelt ? std::abs(distance - height) < 1e-12 : std::isinf(distance)) << distance;
    ASSERT_GE(record["tick_us"][row], record["query_us"][row]);
  }
}

TEST_F(PlaceCommand, FastRecordsWhatTheSpringsSayInEveryTick) {
  const ProcessResult result = placeCone({"--fast", "--record", "out.csv"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, HasSubstr("400 of 400"));
  const Record record(file("out.csv"));
  EXPECT_EQ(record.header(), motionHeader());
  expectTheFallOnTheFloor(record, kTicks, heightAt);
  for (std::size_t i = 0; i < record.rows(); ++i) {
    EXPECT_NEAR(record["t_s"][i], 1e-3 * static_cast<double>(i), 1e-12);
  }
}

TEST_F(PlaceCommand, FastGivesTheSameEachTimeButForTheTimesTaken) {
  ASSERT_EQ(placeCone({"--fast", "--record", "a.csv"}).exitCode, 0);
  ASSERT_EQ(placeCone({"--fast", "--record", "b.csv"}).exitCode, 0);
  const auto withoutTimes = [&](const std::string& name) {
    std::string text;
    const std::vector<std::string> lines = linesOf(readBytes(file(name)));
    const std::vector<std::string> names = cellsOf(lines.at(0));
    for (const std::string& line : lines) {
      const std::vector<std::string> cells = cellsOf(line);
      for (std::size_t i = 0; i < cells.size(); ++i)
        text += names.at(i).ends_with("_us") ? "" : cells[i] + ",";
    }
    return text;
  };
  EXPECT_EQ(withoutTimes("a.csv"), withoutTimes("b.csv"));
}

TEST_F(PlaceCommand, InRealTimeEveryTickIsRecordedAndTheLatenessTold) {
  const auto begin = std::chrono::steady_clock::now();
  const ProcessResult result = placeCone({"--record", "out.csv"});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_GE(seconds, 1e-3 * (kTicks - 1));
  EXPECT_THAT(result.out, HasSubstr("lateness"));
  EXPECT_THAT(result.out, HasSubstr("overruns"));
  EXPECT_THAT(result.out, HasSubstr("SCHED_FIFO"));
  expectTheFallOnTheFloor(Record(file("out.csv")), kTicks, heightAt);
}

TEST_F(PlaceCommand, TheSummaryHoldsPeaksAndLeastDistance) {
  const ProcessResult result = placeCone({"--fast", "--json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["ticks"], kTicks);
  EXPECT_EQ(json["max_lmds"], 1);
  EXPECT_NEAR(json["least_distance"].get<double>(), heightAt(kTicks - 1), 1e-12);
  EXPECT_NEAR(json["peak_force"].get<double>(), 50.0 * (0.1 - heightAt(kTicks - 1)), 1e-9);
  EXPECT_GT(json["query_us"]["p50"], 0.0);
  EXPECT_GE(json["tick_us"]["max"], json["tick_us"]["p99.9"]);
}

TEST_F(PlaceCommand, TheExportHasThePartWhereThePathEnds) {
  ASSERT_EQ(placeCone({"--fast", "--export", "out.json"}).exitCode, 0);
  const auto json = nlohmann::json::parse(readBytes(file("out.json")));
  EXPECT_EQ(json["moving"], "Cone");
  EXPECT_NEAR(json["clearance"]["distance"].get<double>(), heightAt(kTicks - 1), 1e-12);
  for (const auto& part : json["parts"]) {
    if (part["name"] != "Cone") continue;
    EXPECT_NEAR(part["position"][2].get<double>(), heightAt(kTicks - 1), 1e-15);
  }
}

TEST_F(PlaceCommand, APartThatIsUnknownLockedOrHiddenIsRefused) {
  const ProcessResult unknown = place({"--part", "Peg", "--path", "path.csv", "--fast"});
  EXPECT_EQ(unknown.exitCode, 2);
  EXPECT_THAT(unknown.err, HasSubstr("there is no part \"Peg\"; its parts are Floor, Cone"));
  changePart("Cone", [](Part& part) { part.isVisible = false; });
  const ProcessResult hidden = placeCone({"--fast"});
  EXPECT_EQ(hidden.exitCode, 2);
  EXPECT_THAT(hidden.err, HasSubstr("hidden"));
  changePart("Cone", [](Part& part) { part.isLocked = true; });
  const ProcessResult locked = placeCone({"--fast"});
  EXPECT_EQ(locked.exitCode, 2);
  EXPECT_THAT(locked.err, HasSubstr("locked"));
}

TEST_F(PlaceCommand, BadInputIsNamedBeforeAnythingIsWritten) {
  folder_.write("path.csv", "0,0,0,1,0,0,0\n0,0,0,1,0,0\n");
  const ProcessResult badRow = placeCone({"--fast", "--record", "out.csv"});
  EXPECT_EQ(badRow.exitCode, 1);
  EXPECT_THAT(badRow.err, HasSubstr("path.csv:2: 6 values instead of 7"));
  folder_.write("path.csv", pathText(3));
  const ProcessResult noFolder = placeCone({"--fast", "--record", "out.csv", "--export", "missing/out.json"});
  EXPECT_EQ(noFolder.exitCode, 1);
  EXPECT_THAT(noFolder.err, HasSubstr("missing"));
  EXPECT_EQ(placeCone({"--fast", "--record", "same", "--export", "same"}).exitCode, 2);
  EXPECT_EQ(place({"--path", "path.csv"}).exitCode, 2);
  EXPECT_EQ(place({"--part", "Cone"}).exitCode, 2);
  EXPECT_EQ(runCli({"place", "missing.nearfit", "--part", "A", "--path", "path.csv"}, options_).exitCode, 1);
  EXPECT_FALSE(std::filesystem::exists(file("out.csv")));
  EXPECT_FALSE(std::filesystem::exists(file("same")));
}

TEST_F(PlaceCommand, NoInputIsOverwritten) {
  folder_.write("path.csv", pathText(3));
  for (const std::string input : {"fit.nearfit", "path.csv", "floor.obj"}) {
    const std::string before = readBytes(file(input));
    for (const char* option : {"--record", "--export"}) {
      const ProcessResult result = placeCone({"--fast", option, "./" + input});
      EXPECT_EQ(result.exitCode, 2) << input;
      EXPECT_THAT(result.err, HasSubstr(input));
      EXPECT_EQ(readBytes(file(input)), before);
    }
  }
}

// The second silently overwrote the first.
TEST_F(PlaceCommand, RecordAndExportToOneFileAreRefusedHoweverTheyAreSpelled) {
  std::filesystem::create_directory(file("sub"));
  std::filesystem::create_symlink("out", file("link"));
  const auto expectRefused = [&](const std::string& record, const std::string& placement) {
    const ProcessResult result = placeCone({"--fast", "--record", record, "--export", placement});
    EXPECT_EQ(result.exitCode, 2) << record << " " << placement;
    EXPECT_THAT(result.err, HasSubstr("--record: it names the same file as --export; give two files"));
  };
  for (const std::string other : {"./out", "sub/../out", "link"}) {
    expectRefused("out", other);
    expectRefused(other, "out");
  }
  EXPECT_FALSE(std::filesystem::exists(file("out")));
  folder_.write("out", "old");
  std::filesystem::create_hard_link(file("out"), file("same"));
  for (const std::string other : {"./out", "sub/../out", "link", "same"})
    expectRefused("out", other);
  EXPECT_EQ(readBytes(file("out")), "old");
}

// An administrator's --record /dev/null replaced the device.
TEST_F(PlaceCommand, OutputsThatAreNoFilesAreRefusedBeforeTheRun) {
  ASSERT_EQ(::mkfifo(file("pipe").c_str(), 0600), 0);
  folder_.write("long.csv", pathText(60000));
  for (const char* option : {"--record", "--export"}) {
    // In real time this would take a minute.
    const ProcessResult result = place({"--part", "Cone", "--path", "long.csv", option, "pipe"});
    EXPECT_EQ(result.exitCode, 1) << option;
    EXPECT_THAT(result.err, HasSubstr("pipe: it is a device, a pipe or a socket, which no file may replace; "
                                      "choose another name"));
    EXPECT_TRUE(std::filesystem::is_fifo(file("pipe")));
  }
}

// It waited for ever.
TEST_F(PlaceCommand, PathThatIsAPipeIsRefused) {
  ASSERT_EQ(::mkfifo(file("pipe.csv").c_str(), 0600), 0);
  const ProcessResult result = place({"--part", "Cone", "--path", "pipe.csv", "--fast"});
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_THAT(result.err, HasSubstr("pipe.csv: it is not a regular file"));
  const ProcessResult poses = runCli(
      {"lmd", "--unit", "m", "floor.obj", "cone.obj", "--cutoff", "0.1", "--poses", "pipe.csv"}, options_);
  EXPECT_EQ(poses.exitCode, 1);
  EXPECT_THAT(poses.err, HasSubstr("pipe.csv: it is not a regular file"));
}

// The whole recording was lost; where a limit on the size of files stopped it, SIGXFSZ ended the program.
TEST_F(PlaceCommand, RecordingThatCannotGoOnKeepsItsRows) {
  constexpr int kMany = 2000;
  folder_.write("path.csv", pathText(kMany));
  // In units of 512 or 1,024 bytes, as the shell has it.
  const std::string script = "ulimit -f 256; exec \"$0\" \"$@\"";
  const ProcessResult result =
      runProcess({"/bin/sh", "-c", script, test::builtPath("nearfit-cli"), "place", "fit.nearfit", "--part",
                  "Cone", "--path", "path.csv", "--fast", "--record", "out.csv"},
                 options_);
  EXPECT_EQ(result.exitCode, 1) << result.err;
  EXPECT_EQ(linesOf(result.err).size(), 1U);
  EXPECT_THAT(result.err, HasSubstr("out.csv: writing it failed"));
  EXPECT_THAT(result.err, HasSubstr("ulimit -f"));
  EXPECT_THAT(result.err, HasSubstr("the file keeps the rows up to "));
  const Record record(file("out.csv"));
  EXPECT_GT(record.rows(), 200U);
  EXPECT_LT(record.rows(), static_cast<std::size_t>(kMany));
  EXPECT_THAT(result.err, HasSubstr(fmt::format("up to {:.3f} s", record["t_s"].back())));
  EXPECT_FALSE(std::filesystem::exists(file("out.unfinished.csv")));
}

TEST_F(PlaceCommand, HelpTellsTheOptions) {
  const ProcessResult help = runCli({"place", "--help"});
  EXPECT_EQ(help.exitCode, 0);
  for (const char* const option :
       {"--part", "--path", "--fast", "--record", "--export", "--mode", "--margin", "--lock"}) {
    EXPECT_THAT(help.out, HasSubstr(option));
  }
}

/// Starts nearfit-cli, waits until a file in its folder whose name begins so has rows in it, then interrupts
/// it.
int interruptOnce(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                  const std::string& prefix) {
  std::vector<char*> argv;
  for (const std::string& a : arguments)
    argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  const std::string err = (folder / "err.txt").string(), directory = folder.string();
  const pid_t child = ::fork();
  if (child == 0) {
    if (::chdir(directory.c_str()) != 0 || std::freopen(err.c_str(), "w", stderr) == nullptr) ::_exit(99);
    ::execv(argv[0], argv.data());
    ::_exit(98);
  }
  const auto hasBegun = [&] {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (!entry.path().filename().string().starts_with(prefix)) continue;
      std::error_code error;
      const std::uintmax_t size = std::filesystem::file_size(entry.path(), error);
      // The header and some tens of rows.
      if (!error && size > 16384) return true;
    }
    return false;
  };
  EXPECT_TRUE(eventually(hasBegun));
  ::kill(child, SIGINT);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST_F(PlaceCommand, AnInterruptStopsItAndKeepsWhatWasDone) {
  constexpr int kLong = 60000;
  folder_.write("long.csv", pathText(kLong));
  const int exitCode =
      interruptOnce({test::builtPath("nearfit-cli"), "place", "fit.nearfit", "--part", "Cone", "--path",
                     "long.csv", "--record", "out.csv", "--export", "out.json"},
                    folder_.path(), "out.unfinished.csv");
  EXPECT_EQ(exitCode, 1);
  EXPECT_THAT(readBytes(file("err.txt")), HasSubstr("interrupted after"));
  const Record record(file("out.csv"));
  ASSERT_GT(record.rows(), 10U);
  ASSERT_LT(record.rows(), static_cast<std::size_t>(kLong));
  const auto json = nlohmann::json::parse(readBytes(file("out.json")));
  EXPECT_EQ(json["parts"][1]["position"][2].get<double>(), record["proxy_tz"].back());
}

TEST_F(PlaceCommand, ARoundPegGoesDownItsHoleWithTheGapItWasMadeWith) {
  // Pegs run z 0..50 mm, holes z 0..9 mm, both on the z axis; the radial gap is 0.26 mm.
  const std::filesystem::path shared = test::sharedFolder() / "models/public/peghole";
  std::string hole = (shared / "factory_round_hole_16mm_subdiv_3x.obj").string();
  std::string peg = (shared / "factory_round_peg_16mm_loose.obj").string();
  if (!std::filesystem::exists(hole) || !std::filesystem::exists(peg)) {
    const RigidTransform holeUp{glm::dquat(1.0, 0.0, 0.0, 0.0), {0.0, 0.0, 0.0045}};
    const RigidTransform pegUp{glm::dquat(1.0, 0.0, 0.0, 0.0), {0.0, 0.0, 0.025}};
    hole = folder_.write("hole.obj", objText(transformed(tubeMesh(8.26e-3, 0.02, 9e-3, 64), 1.0, holeUp)))
               .string();
    peg = folder_.write("peg.obj", objText(transformed(cylinderMesh(8e-3, 0.05, 64), 1.0, pegUp))).string();
  }
  ASSERT_EQ(runCli({"scene", "new", "fit.nearfit", "--unit", "m", "--part", "Hole=" + hole, "--part",
                    "Peg=" + peg + "@0,0,0.02,1,0,0,0", "--cutoff", "0.001", "--mode", "spring"},
                   options_)
                .exitCode,
            0);
  std::string path;
  for (int i = 0; i <= 200; ++i)
    path += fmt::format("0,0,{},1,0,0,0\n", 0.02 - 1e-4 * i);
  folder_.write("path.csv", path);
  const ProcessResult result =
      place({"--part", "Peg", "--path", "path.csv", "--fast", "--record", "out.csv", "--export", "out.json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const Record record(file("out.csv"));
  ASSERT_EQ(record.rows(), 201U);
  EXPECT_EQ(record["lmds"].front(), 0.0) << "11 mm above the hole";
  for (std::size_t i = 130; i < record.rows(); ++i) {
    // Tessellation takes a little off the gap between the true cylinders, and gives a little where corners
    // face sides.
    ASSERT_GT(record["distance"][i], 0.15e-3) << i;
    ASSERT_LT(record["distance"][i], 0.35e-3) << i;
    ASSERT_GT(record["lmds"][i], 0.0);
  }
}

/// A second cone 0.4 m beside the first and a millimetre higher, both in a group.
void addPair(const std::filesystem::path& file) {
  Scene scene = readSceneFile(file);
  const GroupId pair = scene.addGroup({{}, "Pair", {}, false});
  Part cone = *scene.findByName("Cone");
  cone.group = pair;
  scene.replace(cone);
  cone.worldFromPart.translation += glm::dvec3(0.4, 0.0, 0.001);
  scene.add(cone);
  writeSceneFile(scene, file);
}

TEST_F(PlaceCommand, AGroupMovesAsOneAndItsPartsAreNamed) {
  addPair(file("fit.nearfit"));
  const ProcessResult result = place({"--group", "Pair", "--path", "path.csv", "--fast", "--json", "--record",
                                      "out.csv", "--export", "out.json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto summary = nlohmann::json::parse(result.out);
  EXPECT_EQ(summary["part"], "Cone");
  EXPECT_EQ(summary["group"]["name"], "Pair");
  EXPECT_EQ(summary["group"]["parts"], nlohmann::json({"Cone", "Cone 2"}));
  EXPECT_EQ(summary["others"], 1);
  const Record record(file("out.csv"));
  const double last = heightAt(kTicks - 1);
  EXPECT_EQ(record["proxy_tz"].back(), last) << "the pose is that of the part that leads";
  EXPECT_EQ(record["lmds"].back(), 2.0) << "each tip has one";
  const auto placed = nlohmann::json::parse(readBytes(file("out.json")));
  EXPECT_EQ(placed["moving"], "Cone");
  EXPECT_EQ(placed["movingGroup"]["parts"], nlohmann::json({"Cone", "Cone 2"}));
  EXPECT_NEAR(placed["parts"][2]["position"][0].get<double>(), 0.7, 1e-12);
  EXPECT_NEAR(placed["parts"][2]["position"][2].get<double>(), last + 0.001, 1e-12);
  const auto& to = placed["clearance"]["to"];
  ASSERT_EQ(to.size(), 1U) << "parts of the group are not compared with each other";
  ASSERT_EQ(to[0]["lmds"].size(), 2U);
  EXPECT_EQ(to[0]["lmds"][0]["part"], "Cone");
  EXPECT_EQ(to[0]["lmds"][1]["part"], "Cone 2");
  EXPECT_NEAR(to[0]["lmds"][1]["distance"].get<double>(), last + 0.001, 1e-12);
}

TEST_F(PlaceCommand, AGroupThatCannotBeMovedIsRefusedWithAWord) {
  addPair(file("fit.nearfit"));
  const auto refusal = [this](const std::vector<std::string>& options) {
    std::vector<std::string> all = {"--path", "path.csv", "--fast"};
    all.insert(all.begin(), options.begin(), options.end());
    const ProcessResult result = place(all);
    EXPECT_NE(result.exitCode, 0);
    return result.err;
  };
  EXPECT_THAT(refusal({"--group", "Trio"}), HasSubstr("there is no group \"Trio\""));
  EXPECT_THAT(refusal({}), HasSubstr("give --part NAME or --group NAME"));
  EXPECT_THAT(refusal({"--part", "Cone", "--group", "Pair"}), HasSubstr("--group"));
  changePart("Cone 2", [](Part& part) { part.isLocked = true; });
  EXPECT_THAT(refusal({"--group", "Pair"}), HasSubstr("part \"Cone 2\": it is locked"));
}

}  // namespace
}  // namespace nearfit::test::place_command_test
