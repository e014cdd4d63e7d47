#pragma once

#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "app/cli/ticked_device.h"

namespace nearfit::cli {

/// Result of one step.
struct TestStep {
  enum class Result { Passed, Failed, Skipped };
  std::string name;
  Result result = Result::Passed;
  std::string text;
};

/// Watches the device without touching it: one step for rate and jitter, one for poses.
std::vector<TestStep> watchReports(TickedDevice& ticked);

/// Pushes along a unit axis in the device's frame, rising to `force` [N] and falling smoothly. Gives up at
/// once if the handle runs away or the device stops. The device must be armed.
TestStep push(TickedDevice& ticked, const std::string& name, const glm::dvec3& axis, double force);

/// Strength of the pushes [N]: clearly felt, and dangerous to nobody.
constexpr double kTestForce = 0.5;

}  // namespace nearfit::cli
