// Files of hand poses, and recordings: what is read are poses, as far from the origin as allowed, at times
// that never fall, or there is a FileError.
#include "core/base/error.h"
#include "core/scene/scene.h"
#include "core/servo/motion_reader.h"
#include "device/simulated/replay_device.h"
#include "device/simulated/simulated_device.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::fuzz {
namespace {

void requireNear(const RigidTransform& pose) {
  require(isPose(pose), "poses are finite, their quaternions unit");
  for (int k = 0; k < 3; ++k)
    require(std::abs(pose.translation[k]) <= kMaxPosition, "poses are within reach");
}

void readPath(const std::filesystem::path& file) {
  const std::vector<RigidTransform> poses = readPosePath(file);
  require(!poses.empty(), "a path has poses");
  for (const RigidTransform& pose : poses)
    requireNear(pose);
}

void readRecording(const std::filesystem::path& file) {
  double last = 0.0;
  for (const TimedPose& each : readHandMotion(file)) {
    requireNear(each.worldFromHandle);
    require(each.time >= last, "times begin with zero and never fall");
    last = each.time;
  }
}

void readWholeRecording(const std::filesystem::path& file) {
  double last = 0.0;
  const std::vector<MotionRow> rows = readMotion(file);
  require(!rows.empty(), "a recording has rows");
  for (const MotionRow& row : rows) {
    requireNear(row.handle);
    requireNear(row.proxy);
    require(isFinite(row.wrench.force) && isFinite(row.wrench.torque), "what is felt is finite");
    require(row.distance >= 0.0, "distances are numbers, at least zero");
    require(row.tickTime >= 0.0 && row.lateness >= 0.0 && std::isfinite(row.tickTime + row.lateness),
            "durations are finite, at least zero");
    require(row.time >= last, "times begin with zero and never fall");
    last = row.time;
  }
}

void run(std::string_view text) {
  static const test::TemporaryFolder folder;
  const auto file = folder.write("path.csv", text);
  for (const auto read : {&readPath, &readRecording, &readWholeRecording})
    requireReadOrRefused<FileError>([&] { read(file); });
}

}  // namespace
}  // namespace nearfit::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  nearfit::fuzz::run({reinterpret_cast<const char*>(data), size});
  return 0;
}
