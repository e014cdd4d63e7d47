#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/common/report_stream.h"
#include "tests/usb/driver_fixture.h"

namespace nearfit::driver_damage_test {
namespace {

using testing::HasSubstr;

class DriverWithBadReports : public test::EachDriver {
 protected:
  /// Sends one, and waits until it was seen to be bad.
  void sendBad(const test::BadReport& bad) {
    const std::uint64_t before = device->counters().rejected;
    bench->sendBad(*device, bad);
    if (bad.isOversized) return;
    ASSERT_TRUE(test::promptly([&] { return device->counters().rejected == before + 1; })) << bad.name;
  }
  test::BadReport garbage() {
    std::vector<test::BadReport> all = bench->badReports();
    std::erase_if(all, [](const test::BadReport& bad) { return bad.isOversized; });
    return all.back();
  }

  static constexpr unsigned kMax = ReportStream<int>::kMaxRejectedInRow;
};

TEST_P(DriverWithBadReports, OfEachSortIsCountedAndNotBelievedAndTheNextGoodOneIs) {
  bringUp();
  int place = 0;
  const auto goOn = [&] {
    bench->hold(++place);
    ASSERT_TRUE(bench->round(*device, push, handle));
    bench->expectHeld(*device, handle, place);
  };
  goOn();
  const std::uint64_t poses = device->counters().poses;
  std::uint64_t rejected = 0;
  for (const test::BadReport& bad : bench->badReports()) {
    SCOPED_TRACE(bad.name);
    // It would tell of another place, were it believed.
    bench->hold(place + 1);
    sendBad(bad);
    ASSERT_TRUE(device->readHandle(handle));
    bench->expectHeld(*device, handle, place);
    if (!bad.isOversized) ++rejected;
    goOn();
    EXPECT_EQ(device->state(), DeviceState::Armed) << device->stateNote();
  }
  EXPECT_EQ(device->counters().rejected, rejected) << "each once";
  EXPECT_EQ(device->counters().poses, poses + bench->badReports().size());
}

TEST_P(DriverWithBadReports, InARowThatEndsInTimeStopNothing) {
  bringUp();
  for (int again = 0; again < 3; ++again) {
    for (unsigned i = 0; i + 1 < kMax; ++i)
      sendBad(garbage());
    ASSERT_TRUE(bench->round(*device, push, handle));
    EXPECT_EQ(device->state(), DeviceState::Armed) << device->stateNote();
  }
}

TEST_P(DriverWithBadReports, WithoutEndStopItWithoutForce) {
  bringUp();
  for (unsigned i = 0; i < kMax; ++i)
    sendBad(garbage());
  if (!bench->traits().isStoppedByGarbage) {
    EXPECT_EQ(device->state(), DeviceState::Armed);
    ASSERT_TRUE(bench->round(*device, push, handle));
    return;
  }
  EXPECT_EQ(device->state(), DeviceState::Fault);
  EXPECT_THAT(device->stateNote(), HasSubstr("cannot be read"));
  EXPECT_THROW(device->arm(), DeviceError);
  // Nor does a good one after it set it going again.
  ASSERT_TRUE(bench->round(*device, push, handle));
  ASSERT_TRUE(bench->round(*device, push, handle));
  EXPECT_EQ(device->state(), DeviceState::Fault);
  EXPECT_FALSE(handle.isArmed);
  EXPECT_FALSE(bench->isPushing());
  // Being reset does, and does not arm it.
  device->reset();
  ASSERT_TRUE(bench->round(*device, push, handle));
  ASSERT_TRUE(bench->round(*device, push, handle));
  EXPECT_EQ(device->state(), DeviceState::Ready);
  EXPECT_FALSE(bench->isPushing());
  device->arm();
  ASSERT_TRUE(bench->round(*device, push, handle));
  ASSERT_TRUE(bench->round(*device, push, handle));
  EXPECT_TRUE(bench->isPushing());
}

INSTANTIATE_TEST_SUITE_P(All, DriverWithBadReports, testing::ValuesIn(test::kDriverKinds), test::nameOf);

}  // namespace
}  // namespace nearfit::driver_damage_test
