#pragma once

#include <span>
#include <string>

#include "core/servo/servo_scene.h"
#include "tests/bench/feel_report.h"

namespace nearfit::bench {

/// Quantity of a row that says at how many poses the part meets a body: its mean is their share, its maximum
/// 1 when there is any. Its samples are all poses, less those that are the one before to the last bit.
inline constexpr const char* kMeetings = "poses that meet";

/// Decides for each pose of the part, by exact predicates that share nothing with the proxy, whether it meets
/// a body of the scene or is inside of one.
/// @param worldFromPart  Tick by tick: poses that follow each other nearly cost least
/// (PoseCertifier::meetings).
FeelRow certifiedRow(const std::string& group, const std::string& scene, const std::string& run,
                     const ServoScene& bodies, std::span<const RigidTransform> worldFromPart);

}  // namespace nearfit::bench
