#pragma once

#include "core/math/rigid_transform.h"
#include "core/placing/feature.h"

namespace nearfit {

struct AlignOptions {
  /// Turns the part round: faces then look the same way instead of at each other, axes run the other way.
  bool isFlipped = false;
  /// Left between the features along the fixed one's direction [m]; where canBeOffset() says so.
  double offset = 0.0;
};

/// Whether a distance can be left between two features: where one comes to lie in the plane of the other.
bool canBeOffset(FeatureShape moving, FeatureShape fixed) noexcept;
/// Whether flipping makes a difference: where both have a direction.
bool canBeFlipped(FeatureShape moving, FeatureShape fixed) noexcept;

/// The motion that brings a feature of a part onto another one, both in the world, and leaves the rest as
/// near to where it is as can be: it turns by the least angle, about the moving feature's point, then moves
/// by the least distance.
///
/// | onto     | plane                  | axis                      | circle                 | point     |
/// | plane    | flush, face to face    | square to the axis        | flush with the circle  | through it |
/// | axis     | square to the plane    | coaxial                   | coaxial                | through it |
/// | circle   | flush with the plane   | coaxial                   | coaxial, centre on it  | centre on it |
/// | point    | in the plane           | on the axis               | on the centre          | on it |
///
/// Without a side of their own, axes and circles take the sense that is nearer.
/// @param moving, fixed  Directions unit; everything finite.
/// @return worldFromWorld: the part's new pose is this times the present one.
RigidTransform alignMotion(const AlignFeature& moving, const AlignFeature& fixed,
                           const AlignOptions& options = {});

}  // namespace nearfit
