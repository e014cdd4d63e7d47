// devices --test as its reader sees it, at a terminal: what it asks for, and that a force follows only where all went the
// way that was asked.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/cli/device_test.h"
#include "app/cli/output.h"
#include "core/base/error.h"
#include "device/openhap/openhap_device.h"
#include "device/usb/usb_bus.h"
#include "tests/support/temporary_folder.h"
#include "tests/usb/emulated_bus.h"
#include "tests/usb/openhap_emulator.h"

namespace nearfit::device_guide_test {
namespace {

using nlohmann::json;
using test::OpenHapFirmware;
using testing::HasSubstr;
using testing::Not;

/// What somebody at a terminal does, and types, when it says something.
struct Reaction {
  std::string words;
  std::function<void()> act;
  std::string answer = {};
};

/// A terminal that the program's input and output are until the end of the scope, and somebody in front of it.
class Terminal {
 public:
  explicit Terminal(std::vector<Reaction> reactions)
      : reactions_(std::move(reactions)), master_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0)
      throw std::runtime_error("no terminal");
    std::array<char, 128> name{};
    if (::ptsname_r(master_, name.data(), name.size()) != 0) throw std::runtime_error("no terminal's name");
    const int end = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (end < 0) throw std::runtime_error("the terminal does not open");
    std::fflush(stdout);
    for (const int each : {STDIN_FILENO, STDOUT_FILENO}) {
      before_.at(static_cast<std::size_t>(each)) = ::dup(each);
      ::dup2(end, each);
    }
    ::close(end);
    reader_ = std::thread([this] { read(); });
  }
  ~Terminal() {
    if (reader_.joinable()) close();
    ::close(master_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Gives input and output back. Returns all that was said.
  std::string close() {
    std::fflush(stdout);
    for (const int each : {STDIN_FILENO, STDOUT_FILENO}) {
      const int old = before_.at(static_cast<std::size_t>(each));
      if (old < 0) {
        ::close(each);
        continue;
      }
      ::dup2(old, each);
      ::close(old);
    }
    // Its last end is closed: reading fails.
    reader_.join();
    return said_;
  }

 private:
  void type(const std::string& line) const {
    const std::string text = line + "\n";
    EXPECT_EQ(::write(master_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void read() {
    std::vector<std::size_t> seen(reactions_.size(), 0);
    std::array<char, 1024> bytes{};
    for (;;) {
      const ssize_t count = ::read(master_, bytes.data(), bytes.size());
      if (count <= 0) return;
      said_.append(bytes.data(), static_cast<std::size_t>(count));
      for (std::size_t i = 0; i < reactions_.size(); ++i) {
        const std::size_t at = said_.find(reactions_[i].words, seen[i]);
        if (at == std::string::npos) continue;
        seen[i] = at + reactions_[i].words.size();
        if (reactions_[i].act) reactions_[i].act();
        if (!reactions_[i].answer.empty()) type(reactions_[i].answer);
      }
    }
  }

  const std::vector<Reaction> reactions_;
  const int master_;
  std::array<int, 2> before_{-1, -1};
  std::string said_;  ///< Reader's, until it has ended.
  std::thread reader_;
};

/// An emulated OpenHap device with motors for force and torque, and a hand that does as it is asked, or the mirror image.
class GuidedDeviceTest : public testing::Test {
 protected:
  /// Slow, and lenient towards threads that do not run for a while: timing decides nothing here.
  static openhap::Capabilities lenient(bool needsHoming) {
    openhap::Capabilities is = test::OpenHapEmulator::usualCapabilities();
    is.rate = 30;
    is.watchdogMs = 10'000;
    is.needsHoming = needsHoming;
    return is;
  }
  void plugIn(bool needsHoming = false) {
    emulator_ = std::make_unique<test::OpenHapEmulator>(lenient(needsHoming));
    bus_.plug(emulator_->device());
    SafetyLimits safety;
    safety.patience = {10.0, 10.0};
    device_ = std::make_unique<OpenHapDevice>(UsbBus().list().at(0), safety);
    emulator_->stream({.hand = [this](OpenHapFirmware& firmware, double) {
      const std::lock_guard lock(mutex_);
      firmware.isHomed = firmware.isHomed || isHomed_;
      const std::array<float, 3> force = firmware.lastWrench().force, torque = firmware.lastWrench().torque;
      wasArmed_ = wasArmed_ || firmware.isArmed();
      for (std::size_t i = 0; i < 3; ++i) {
        firmware.handle.position[i] = static_cast<float>(at_[i] + give_ * force[i]);
        most_[i] = std::max(most_[i], std::abs(force[i]));
        mostTorque_[i] = std::max(mostTorque_[i], std::abs(torque[i]));
      }
      firmware.handle.rotation = {static_cast<float>(turn_.w), static_cast<float>(turn_.x),
                                  static_cast<float>(turn_.y), static_cast<float>(turn_.z)};
    }});
  }
  void move(double x, double y, double z) {
    const std::lock_guard lock(mutex_);
    at_[0] += isMirrored_ ? -x : x;
    at_[1] += y;
    at_[2] += z;
  }
  /// About one axis, right-handed.
  void turn(double x, double y, double z) {
    const std::lock_guard lock(mutex_);
    const double half = 0.4;
    turn_ = glm::dquat(std::cos(half), std::sin(half) * x, std::sin(half) * y, std::sin(half) * z) * turn_;
  }
  /// What the words mean in Nearfit's frame: x to the right, y away, z up.
  std::vector<Reaction> obedient() {
    return {{"Push the handle to the right", [this] { move(0.05, 0.0, 0.0); }},
            {"Push the handle away from you", [this] { move(0.0, 0.05, 0.0); }},
            {"Lift the handle", [this] { move(0.0, 0.0, 0.05); }},
            // Up becomes towards: z becomes -y.
            {"Tip the top of the handle towards you", [this] { turn(1.0, 0.0, 0.0); }},
            // Up becomes right: z becomes x.
            {"Tip the top of the handle to the right", [this] { turn(0.0, 1.0, 0.0); }},
            // From above, right becomes towards: x becomes -y.
            {"Turn the handle clockwise, as seen from above", [this] { turn(0.0, 0.0, -1.0); }}};
  }
  /// Runs the test at a terminal. Returns what it said; `hasFailed_` tells how it ended.
  std::string guided(std::vector<Reaction> reactions, bool hasConsent = false) {
    reactions.push_back({"Type yes", nullptr, "no"});
    reactions.push_back({"waiting for", [this] {
                           const std::lock_guard lock(mutex_);
                           isHomed_ = true;
                         }});
    Terminal terminal(std::move(reactions));
    try {
      cli::testDevice(*device_, {hasConsent, false, false, folder_.path() / "report.json"});
    } catch (const Error&) {
      hasFailed_ = true;
    }
    std::string said = terminal.close();
    emulator_->stopStreaming();
    return said;
  }
  /// Runs it where nobody is. Returns the report's steps by name, with their results and texts.
  std::vector<json> unguided(bool allowsUnjudgedAxes) {
    testing::internal::CaptureStdout();
    try {
      cli::testDevice(*device_, {true, true, false, folder_.path() / "report.json", allowsUnjudgedAxes});
    } catch (const Error&) {
      hasFailed_ = true;
    }
    cli::flushOutput();
    testing::internal::GetCapturedStdout();
    emulator_->stopStreaming();
    return steps();
  }
  std::vector<json> steps() const {
    std::ifstream in(folder_.path() / "report.json");
    return json::parse(in)["steps"].get<std::vector<json>>();
  }
  static std::string resultOf(const std::vector<json>& steps, const std::string& name) {
    for (const json& each : steps)
      if (each["name"] == name) return each["result"];
    return "none";
  }

  const test::TemporaryFolder folder_;
  test::EmulatedBus bus_;
  std::unique_ptr<test::OpenHapEmulator> emulator_;
  std::unique_ptr<OpenHapDevice> device_;
  bool isMirrored_ = false, hasFailed_ = false;
  double give_ = 0.0;  ///< How far the handle gives way to a force [m/N].

  std::mutex mutex_;
  std::array<double, 3> at_{};
  glm::dquat turn_{1.0, 0.0, 0.0, 0.0};
  bool isHomed_ = false;
  // The emulator's thread's, until it is stopped.
  std::array<float, 3> most_{}, mostTorque_{};
  bool wasArmed_ = false;
};

TEST_F(GuidedDeviceTest, AHandleThatMovesAsAskedMayBePushed) {
  plugIn();
  const std::string said = guided(obedient());
  EXPECT_FALSE(hasFailed_) << said;
  for (const char* step : {"noise", "axis x", "axis y", "axis z", "turn x", "turn y", "turn z"})
    EXPECT_EQ(resultOf(steps(), step), "pass") << step << "\n" << said;
  EXPECT_THAT(said, HasSubstr("up to 0.50 N for a second along each axis, and turn it with up to 0.05 N m"));
  EXPECT_FALSE(wasArmed_) << "the answer was no";
}

/// Even with --yes.
TEST_F(GuidedDeviceTest, AMirroredHandleGetsNoForce) {
  plugIn();
  isMirrored_ = true;
  const std::string said = guided(obedient(), true);
  EXPECT_TRUE(hasFailed_) << said;
  EXPECT_EQ(resultOf(steps(), "axis x"), "fail") << said;
  EXPECT_EQ(resultOf(steps(), "axis y"), "pass") << said;
  EXPECT_THAT(said, Not(HasSubstr("Type yes")));
  EXPECT_FALSE(wasArmed_);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(most_[i], 0.0F);
    EXPECT_EQ(mostTorque_[i], 0.0F);
  }
}

TEST_F(GuidedDeviceTest, TheHandlesPlaceIsFoundBeforeItIsJudged) {
  plugIn(/*needsHoming=*/true);
  const std::string said = guided(obedient());
  EXPECT_FALSE(hasFailed_) << said;
  const std::vector<json> found = steps();
  const auto placeOf = [&](const char* name) {
    return std::find_if(found.begin(), found.end(), [&](const json& each) { return each["name"] == name; }) -
           found.begin();
  };
  EXPECT_EQ(resultOf(found, "calibrate"), "pass") << said;
  EXPECT_LT(placeOf("calibrate"), placeOf("noise")) << said;
  EXPECT_EQ(resultOf(found, "axis x"), "pass") << said;
}

TEST_F(GuidedDeviceTest, WhereNobodyJudgesTheAxesNoForceFollows) {
  plugIn();
  const std::vector<json> found = unguided(false);
  EXPECT_FALSE(hasFailed_);
  EXPECT_EQ(resultOf(found, "axes"), "skip");
  ASSERT_EQ(resultOf(found, "forces"), "skip");
  EXPECT_THAT(found.back()["text"].get<std::string>(), HasSubstr("--unjudged-axes"));
  EXPECT_FALSE(wasArmed_);
}

TEST_F(GuidedDeviceTest, ForcesAndTorquesRiseInStepsWhereTheAxesNeedNoJudge) {
  plugIn();
  give_ = 0.004;
  const std::vector<json> found = unguided(true);
  EXPECT_FALSE(hasFailed_) << json(found);
  for (const char* step :
       {"push 0.1 N", "push 0.2 N", "push 0.3 N", "push x", "push y", "push z", "twist 0.01 N m",
        "twist 0.02 N m", "twist 0.03 N m", "twist x", "twist y", "twist z", "disarm"})
    EXPECT_EQ(resultOf(found, step), "pass") << step << "\n" << json(found);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_GT(most_[i], 0.0F);
    EXPECT_LE(most_[i], 0.5F + 1e-6F);
    EXPECT_GT(mostTorque_[i], 0.0F);
    EXPECT_LE(mostTorque_[i], 0.05F + 1e-6F);
  }
  // It gives way with the next report, some 33 ms later. A machine that is busy may take longer than it is waited for.
  const std::string latency = resultOf(found, "latency");
  EXPECT_TRUE(latency == "pass" || latency == "skip") << json(found);
}

TEST_F(GuidedDeviceTest, AHandleThatMovesAgainstTheForceFails) {
  plugIn();
  give_ = -0.02;
  const std::vector<json> found = unguided(true);
  EXPECT_TRUE(hasFailed_);
  const auto failed =
      std::find_if(found.begin(), found.end(), [](const json& each) { return each["result"] == "fail"; });
  ASSERT_NE(failed, found.end()) << json(found);
  EXPECT_THAT((*failed)["text"].get<std::string>(), HasSubstr("against the force")) << json(found);
  EXPECT_EQ(most_[0], 0.0F) << "the first pushes are along z, and none follows one that failed";
  EXPECT_GT(most_[2], 0.0F);
}

}  // namespace
}  // namespace nearfit::device_guide_test
