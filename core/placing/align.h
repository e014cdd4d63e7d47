#pragma once

#include "core/math/rigid_transform.h"
#include "core/placing/feature.h"

namespace nearfit {

/// Options of alignMotion().
struct AlignOptions {
  /// Turns the moving part round: faces then look the same way instead of at each other, and axes take the
  /// opposite sense.
  bool isFlipped = false;
  /// Distance left between the features along the fixed one's direction [m]; only where canBeOffset().
  double offset = 0.0;
};

/// True if a distance can be left between two features: one of them ends up in the plane of the other.
bool canBeOffset(FeatureShape moving, FeatureShape fixed) noexcept;
/// True if flipping makes a difference: both features have a direction.
bool canBeFlipped(FeatureShape moving, FeatureShape fixed) noexcept;

/// The smallest motion that brings a feature of a part onto a fixed one, both in the world frame: the least
/// rotation, about the moving feature's point, then the least translation.
///
/// | moving \ fixed | plane                | axis                  | circle                | point        |
/// | plane          | flush, face to face  | perpendicular to it   | flush with it         | through it   |
/// | axis           | perpendicular to it  | coaxial               | coaxial               | through it   |
/// | circle         | flush with it        | coaxial               | coaxial, same centre  | centre on it |
/// | point          | in it                | on it                 | on its centre         | on it        |
///
/// The directions of axes and circles have no sign; the nearer one is taken.
/// @param moving, fixed  Unit directions; everything finite.
/// @return worldFromWorld: the part's new pose is this times its present one.
RigidTransform alignMotion(const AlignFeature& moving, const AlignFeature& fixed,
                           const AlignOptions& options = {});

}  // namespace nearfit
