#include "device/falcon/falcon_firmware.h"

#include <algorithm>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/interface/device_error.h"
#include "tests/support/temporary_folder.h"
#include "tests/usb/falcon_firmware.h"

namespace nearfit::falcon::falcon_firmware_test {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::byte>;

/// The port of a Falcon without USB in between.
class DirectTransport final : public FtdiTransport {
 public:
  explicit DirectTransport(test::FalconFirmware& firmware) : firmware_(firmware) {}
  void control(std::uint8_t request, std::uint16_t value) override {
    if (!firmware_.onRequest(0x40, request, value))
      throw DeviceError(DeviceProblem::NotAnswering, "", "stall");
  }
  void write(std::span<const std::byte> data) override { firmware_.onBytes(data); }
  std::size_t read(std::span<std::byte> packet, Timeout) override {
    const Bytes bytes = firmware_.takeBytes(packet.size() - FtdiPort::kStatusSize);
    packet[0] = packet[1] = std::byte{0x60};
    std::copy(bytes.begin(), bytes.end(), packet.begin() + FtdiPort::kStatusSize);
    return bytes.size() + FtdiPort::kStatusSize;
  }

 private:
  test::FalconFirmware& firmware_;
};

/// Not a whole number of blocks, and all values of bytes.
Bytes image() {
  Bytes bytes;
  for (int i = 0; i < 62 * 40 + 17; ++i)
    bytes.push_back(static_cast<std::byte>(i * 7 & 0xff));
  return bytes;
}

class FalconUpload : public testing::Test {
 protected:
  test::FalconFirmware falcon{image()};
  DirectTransport transport{falcon};
  FtdiPort port{transport};

  DeviceError errorOf(const Bytes& firmware) {
    try {
      uploadFirmware(port, firmware, "Falcon");
    } catch (const DeviceError& error) {
      return error;
    }
    ADD_FAILURE() << "no error";
    return {DeviceProblem::Failed, "", ""};
  }
};

TEST_F(FalconUpload, FirmwareIsLoadedAndRuns) {
  EXPECT_FALSE(isFirmwareRunning(port));
  uploadFirmware(port, image(), "Falcon");
  EXPECT_TRUE(falcon.isRunning());
  EXPECT_TRUE(isFirmwareRunning(port));
  EXPECT_EQ(falcon.uploads(), 1);
}

TEST_F(FalconUpload, FirmwareThatRunsIsFound) {
  falcon.run();
  EXPECT_TRUE(isFirmwareRunning(port));
  EXPECT_EQ(falcon.uploads(), 0);
}

TEST_F(FalconUpload, ALoaderThatIsSlowToAnswerIsGreetedAgain) {
  falcon.deafGreetings = 7;
  uploadFirmware(port, image(), "Falcon");
  EXPECT_TRUE(falcon.isRunning());
}

TEST_F(FalconUpload, AZeroBeforeTheLoadersAnswerDoesNoHarm) {
  falcon.hasLeadingZero = true;
  uploadFirmware(port, image(), "Falcon");
  EXPECT_TRUE(falcon.isRunning());
}

TEST_F(FalconUpload, ABlockThatCameBackWrongIsAnotherAttempt) {
  falcon.wrongEchoes = 2;
  uploadFirmware(port, image(), "Falcon");
  EXPECT_TRUE(falcon.isRunning());
  EXPECT_EQ(falcon.uploads(), 3);
}

TEST_F(FalconUpload, ProgressGoesFromNothingUpAndNeverFallsHoweverOftenItIsTried) {
  falcon.wrongEchoes = 1;
  std::vector<double> told;
  uploadFirmware(port, image(), "Falcon", [&](double fraction) {
    told.push_back(fraction);
    return true;
  });
  // 40 blocks and a rest, and the first block twice.
  ASSERT_EQ(told.size(), 42U);
  EXPECT_EQ(told.front(), 0.0);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_NEAR(told.back(), 62.0 * 40 / (62 * 40 + 17), 1e-12);
}

TEST_F(FalconUpload, ItEndsAtTheNextBlockOnceNobodyWantsIt) {
  int blocks = 0;
  EXPECT_THROW(uploadFirmware(port, image(), "Falcon", [&](double) { return ++blocks < 4; }), Cancelled);
  EXPECT_EQ(blocks, 4);
  EXPECT_FALSE(falcon.isRunning());
}

TEST_F(FalconUpload, WithoutPowerItSaysThatTheLoaderIsSilent) {
  falcon.isPowered = false;
  const DeviceError error = errorOf(image());
  EXPECT_EQ(error.cause(), DeviceProblem::NotAnswering);
  EXPECT_THAT(error.problem(), HasSubstr("loader does not answer"));
  EXPECT_THAT(error.remedy(), HasSubstr("power supply"));
}

TEST_F(FalconUpload, ALoaderThatTakesNothingIsTold) {
  falcon.refusesBegin = true;
  EXPECT_THAT(errorOf(image()).problem(), HasSubstr("does not accept firmware"));
}

TEST_F(FalconUpload, BlocksThatKeepComingBackWrongAreTold) {
  falcon.wrongEchoes = 1000;
  const DeviceError error = errorOf(image());
  EXPECT_THAT(error.problem(), HasSubstr("byte 0 of the firmware incorrectly (5 attempts)"));
  EXPECT_THAT(error.remedy(), HasSubstr("hub"));
  EXPECT_EQ(falcon.uploads(), kUploads);
}

TEST_F(FalconUpload, AnUploadThatStopsIsToldWithThePlace) {
  falcon.mostBytes = 100;
  EXPECT_THAT(errorOf(image()).problem(), HasSubstr("stopped accepting firmware at byte 100 of 2497"));
}

TEST_F(FalconUpload, AFileOfSomethingElseDoesNotRun) {
  Bytes other = image();
  other.back() ^= std::byte{1};
  const DeviceError error = errorOf(other);
  EXPECT_THAT(error.problem(), HasSubstr("does not run it"));
  EXPECT_THAT(error.remedy(), HasSubstr("check that the file"));
}

TEST(FalconFirmwareFile, IsReadAsItIs) {
  const test::TemporaryFolder folder;
  const std::string content(1000, 'x');
  EXPECT_EQ(readFirmware(folder.write("f.bin", content), "Falcon"), Bytes(1000, std::byte{'x'}));
}

TEST(FalconFirmwareFile, WithoutAPathItSaysWhatIsWanted) {
  try {
    readFirmware({}, "Falcon");
    FAIL();
  } catch (const DeviceError& error) {
    EXPECT_EQ(error.cause(), DeviceProblem::NoFirmware);
    EXPECT_THAT(error.remedy(), HasSubstr("maker"));
  }
}

TEST(FalconFirmwareFile, OfAnotherSizeThanFirmwareHasIsRefused) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(readFirmware(folder.write("small", std::string(kMinFirmware - 1, 'x')), "Falcon"),
               DeviceError);
  EXPECT_THROW(readFirmware(folder.write("big", std::string(kMaxFirmware + 1, 'x')), "Falcon"), DeviceError);
  EXPECT_EQ(readFirmware(folder.write("least", std::string(kMinFirmware, 'x')), "Falcon").size(),
            kMinFirmware);
}

TEST(FalconFirmwareFile, ThatIsNotThereOrAFolderIsRefused) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(readFirmware(folder.path() / "none", "Falcon"), FileError);
  EXPECT_THROW(readFirmware(folder.path(), "Falcon"), FileError);
}

}  // namespace
}  // namespace nearfit::falcon::falcon_firmware_test
