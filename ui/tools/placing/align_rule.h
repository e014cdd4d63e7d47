#pragma once

#include <array>
#include <optional>

#include "core/mesh/triangle_mesh.h"
#include "core/placing/align.h"
#include "core/placing/feature_pick.h"
#include "core/scene/joint.h"

namespace nearfit::ui {

/// A way to bring a feature of a part onto one of another part by two clicks. AlignTool translates the texts.
struct AlignRule {
  const char* name;  ///< Object name of its action.
  const char *text, *help, *icon, *keys;
  const char* verb;  ///< Of the undo step, before the part's name; not for a joint.
  const char *movingPrompt, *fixedPrompt;
  /// Kinds of features that can be picked; nullopt: the user chooses.
  std::optional<FeatureFilter> filter;
  /// The joint that it makes; nullopt: it only moves the part.
  std::optional<JointKind> joint;
  /// Returns what counts of a picked feature, in the mesh's frame.
  AlignFeature (*featureOf)(const TriangleMesh& mesh, const PickedFeature& picked);
  /// Returns worldFromWorld; features are in the world.
  RigidTransform (*motion)(const AlignFeature& moving, const AlignFeature& fixed, const AlignOptions& how);
  /// True if a distance can be left between the features.
  bool (*canBeApart)(FeatureShape moving, FeatureShape fixed) noexcept;
};

/// Align, Insert, Keep on axis, Keep in plane, Keep to point.
const std::array<AlignRule, 5>& alignRules();

}  // namespace nearfit::ui
