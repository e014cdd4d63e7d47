#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/base/progress.h"
#include "core/path/certificate.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Result of a verification.
struct Verification {
  /// The first difference, or the first place that is not proven, in words; empty if everything is proven.
  std::string problem;
  std::size_t stretches = 0;  ///< Number of stretches that were proven anew.

  bool isProven() const noexcept { return problem.empty(); }
};

/// Proves a certificate anew against a scene. Checks that meshes, poses and names are those that it is about, that its
/// stretches cover the path for each pair of parts, and proves for each stretch that the surfaces are as far apart at
/// its anchor as it claims, and that no point of the part moves so far that less than the separation is left. At the
/// start of the path it proves that no part is inside another.
///
/// It shares no search with the certifier: its trees (triangle_boxes.h), its test of two triangles, its bound on motion
/// and its test of what is inside are its own. What both use are the scene, the path and its interpolation, and the
/// order of parts (pathBodies). On all processors; memory of about 200 bytes a triangle.
///
/// @param sceneSha256  Of the scene file; must be the certificate's, if that has one.
/// @param path         If given, must be the certificate's.
/// Throws Cancelled.
Verification verifyCertificate(const Certificate& certificate, const Scene& scene,
                               const std::string& sceneSha256,
                               const std::optional<AssemblyPath>& path = std::nullopt,
                               const ProgressCallback& progress = {});

}  // namespace nearfit
