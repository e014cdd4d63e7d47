#pragma once

#include <optional>

#include "core/path/assembly_path.h"
#include "core/picture/scene_picture.h"
#include "core/scene/scene.h"
#include "core/verdict/scene_check.h"

namespace nearfit {

/// The visible parts of a scene from a side, with the way of a path's centre.
/// @param path           Null: none. Its first part is in the scene.
/// @param width, height  Of the picture [pixels].
ScenePicture sceneView(const Scene& scene, PictureSide side, const AssemblyPath* path, int width, int height);

/// Pictures of what a check found of two parts. The other parts are left out; the larger part is translucent.
struct FindingViews {
  ScenePicture whole;                 ///< Both parts, with a frame around what the close one shows.
  std::optional<ScenePicture> close;  ///< The place itself; no value if the whole shows it as large.
};

/// Views across the gap or the depth, so that it is seen at its length. Minima are drawn as segments, clashes as the
/// curves where the surfaces meet and the translation that frees the part.
FindingViews findingViews(const Scene& scene, const PairFinding& finding, int width, int height);

}  // namespace nearfit
