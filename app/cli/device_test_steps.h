#pragma once

#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "app/cli/ticked_device.h"

namespace nearfit::cli {

struct TestStep {
  enum class Result { Passed, Failed, Skipped };
  std::string name;
  Result result = Result::Passed;
  std::string text;
};

/// What is measured while nothing is done to it: rate, jitter, poses. Two steps.
std::vector<TestStep> watchReports(TickedDevice& ticked);

/// A push of at most `force` along an axis that comes and goes smoothly, given up at once when the handle
/// runs away or the device stops. The device is armed.
TestStep push(TickedDevice& ticked, const std::string& name, const glm::dvec3& axis, double force);

/// How strong the pushes are [N]: well felt, and no danger to anybody.
constexpr double kTestForce = 0.5;

}  // namespace nearfit::cli
