#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tests/usb/driver_bench.h"
#include "tests/usb/usb_fixture.h"

namespace nearfit::test {

/// A bus with one device in it, and its driver.
class DriverRig : public testing::Test {
 protected:
  /// Plugs the device in and makes its driver.
  void use(const DriverKind& kind);
  /// Its driver, as it is plugged in now.
  void make(const SafetyLimits& safety = lenientSafety());
  /// Opens it, brings it to where it can be armed, arms it.
  void bringUp();
  /// Lets the device speak, and a servo answer, until forces come through.
  void streamAndFeel();
  /// What opening it fails with.
  DeviceError errorOfStart();
  /// It is open no more and the host has left nothing behind.
  void expectClosed(DeviceState state);

  EmulatedDevice& emulated() { return *bench->emulated(); }
  bool pushes() { return bench->traits().pushes; }

  const Wrench push{{0.5, -1.0, 1.5}, {0.0, 0.0, 0.0}};
  EmulatedBus bus;
  std::unique_ptr<DriverBench> bench;
  std::unique_ptr<HapticDevice> device;
  std::unique_ptr<SteadyServo> servo;
  HandleInput handle;
};

/// The same for each driver.
class EachDriver : public DriverRig, public testing::WithParamInterface<DriverKind> {
 protected:
  void SetUp() override { use(GetParam()); }
};

inline std::string nameOf(const testing::TestParamInfo<DriverKind>& instance) {
  return instance.param.name;
}

}  // namespace nearfit::test
