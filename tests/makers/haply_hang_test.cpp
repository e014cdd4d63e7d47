// Haply's service accepts the connection and then hangs: whoever waits for it is told in bounded time, and can close. Time
// decides nothing here: the stand-in says that it hangs, and does so until Nearfit closes the connection.
#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/interface/device_error.h"
#include "tests/makers/maker_bench.h"
#include "tests/support/eventually.h"
#include "tests/support/scoped_variable.h"

namespace nearfit::haply_hang_test {
namespace {

using test::eventually;
using test::HaplyHang;
using test::ScopedVariable;
using testing::AnyOf;
using testing::HasSubstr;

/// For NEARFIT_HAPLY_PATIENCE [ms]. What hangs never answers, however short this is; what does not hang is tried until it
/// answers within it.
constexpr const char* kShortPatience = "200";

const char* placeOf(HaplyHang where) {
  switch (where) {
    case HaplyHang::Never:
      return "Never";
    case HaplyHang::AtHandshake:
      return "AtHandshake";
    case HaplyHang::AtMessage:
      return "AtMessage";
    case HaplyHang::InFrame:
      return "InFrame";
    case HaplyHang::InMessage:
      return "InMessage";
  }
  return "";
}

class HaplyServiceThatHangs : public testing::TestWithParam<HaplyHang> {
 protected:
  test::HaplyStandin& service() { return bench.service(); }
  /// Returns the words of the DeviceError that `act` throws; empty if it throws none. If `act` does not return, that is a
  /// failure, and the service ends so that it does.
  template <class Act>
  std::string problemOf(Act&& act) {
    std::string words;
    std::future<void> done = std::async(std::launch::async, [&] {
      try {
        act();
      } catch (const DeviceError& error) {
        words = error.what();
      }
    });
    if (done.wait_for(test::kPatience) != std::future_status::ready) {
      ADD_FAILURE() << "it waits for a service that hangs";
      service().end();
    }
    done.get();
    return words;
  }
  /// Has the service hang, and returns problemOf(act) once a connection hung; a busy machine may keep the service from it.
  template <class Act>
  std::string problemWhileItHangs(Act&& act) {
    const ScopedVariable patience("NEARFIT_HAPLY_PATIENCE", kShortPatience);
    service().hang(GetParam());
    std::string problem;
    EXPECT_TRUE(eventually([&] {
      problem = problemOf(act);
      return service().hangs() > 0;
    }));
    return problem;
  }
  bool areHangingConnectionsClosed() {
    return eventually([this] { return service().hung() == 0; });
  }

  test::MakerBench bench{test::kMakerModels[6]};
};

TEST_P(HaplyServiceThatHangs, ListsNothingAndSaysWhy) {
  EXPECT_THAT(problemWhileItHangs([this] { bench.plugin()->devices(); }), HasSubstr("Haply Inverse Service"));
  EXPECT_TRUE(areHangingConnectionsClosed());
  service().hang(HaplyHang::Never);
  EXPECT_EQ(bench.plugin()->devices().size(), 1U);
}

TEST_P(HaplyServiceThatHangs, OpensNoDevice) {
  const std::unique_ptr<HapticDevice> device = bench.make();
  const std::string problem = problemWhileItHangs([&] { device->start({}); });
  EXPECT_THAT(problem, HasSubstr("it could not be opened"));
  EXPECT_THAT(problem, HasSubstr("Haply Inverse Service"));
  EXPECT_EQ(device->state(), DeviceState::Present);
  EXPECT_EQ(problemOf([&] { device->stop(); }), "");
  EXPECT_TRUE(areHangingConnectionsClosed());
  service().hang(HaplyHang::Never);
  device->start({});
  EXPECT_EQ(device->state(), DeviceState::Ready) << device->stateNote();
}

INSTANTIATE_TEST_SUITE_P(All, HaplyServiceThatHangs,
                         testing::Values(HaplyHang::AtHandshake, HaplyHang::AtMessage, HaplyHang::InFrame,
                                         HaplyHang::InMessage),
                         [](const auto& each) { return std::string(placeOf(each.param)); });

/// The connection is open, and was of use.
class HaplyServiceThatHangsLater : public HaplyServiceThatHangs {
 protected:
  /// Opens the device; a busy machine may not let the service answer in time.
  bool opens() {
    servo.reset();
    service().hang(HaplyHang::Never);
    try {
      if (!device) device = bench.make();
      device->start({});
    } catch (const DeviceError&) {
      return false;
    }
    servo.emplace(*device);
    return true;
  }
  /// Returns once the open device waits for what does not come; begins anew if a busy machine lost it before.
  void hangWhileItIsOpen() {
    ASSERT_TRUE(eventually([this] {
      if (!opens()) return false;
      const int before = service().hangs();
      service().hang(GetParam());
      const auto hangs = [&] { return service().hangs() > before; };
      return eventually([&] { return hangs() || device->state() == DeviceState::Lost; }) && hangs();
    }));
  }
  void expectThatItOpensAgain() {
    EXPECT_TRUE(areHangingConnectionsClosed());
    EXPECT_TRUE(eventually([this] { return opens() && device->state() == DeviceState::Ready; }))
        << device->stateNote();
  }
  void TearDown() override {
    servo.reset();
    device.reset();
  }

  const ScopedVariable shortPatience{"NEARFIT_HAPLY_PATIENCE", kShortPatience};
  std::unique_ptr<HapticDevice> device;
  std::optional<test::MakerServo> servo;
};

TEST_P(HaplyServiceThatHangsLater, LosesTheDeviceAndSaysWhy) {
  hangWhileItIsOpen();
  EXPECT_TRUE(eventually([this] { return device->state() == DeviceState::Lost; }));
  EXPECT_THAT(device->stateNote(), HasSubstr("Haply Inverse Service"));
  EXPECT_TRUE(eventually([this] { return servo->hasEnded(); }));
  servo.reset();
  EXPECT_EQ(problemOf([this] { device->stop(); }), "");
  expectThatItOpensAgain();
}

TEST_P(HaplyServiceThatHangsLater, HoldsUpNobodyWhoClosesTheDevice) {
  hangWhileItIsOpen();
  EXPECT_EQ(problemOf([this] {
              servo.reset();
              device->stop();
            }),
            "");
  // Lost if it was found to hang before it was closed.
  EXPECT_THAT(device->state(), AnyOf(DeviceState::Present, DeviceState::Lost));
  expectThatItOpensAgain();
}

TEST_P(HaplyServiceThatHangsLater, ListsNothingOverAConnectionThatWasKept) {
  const auto list = [this] { return bench.plugin()->devices().size(); };
  ASSERT_TRUE(eventually([&] {
    try {
      return list() == 1;
    } catch (const DeviceError&) {
      return false;
    }
  }));
  service().hang(GetParam());
  EXPECT_THAT(problemOf(list), HasSubstr("Haply Inverse Service"));
  EXPECT_TRUE(eventually([this] { return service().hangs() > 0; }));
  EXPECT_TRUE(areHangingConnectionsClosed());
}

INSTANTIATE_TEST_SUITE_P(All, HaplyServiceThatHangsLater,
                         testing::Values(HaplyHang::AtMessage, HaplyHang::InFrame, HaplyHang::InMessage),
                         [](const auto& each) { return std::string(placeOf(each.param)); });

}  // namespace
}  // namespace nearfit::haply_hang_test
