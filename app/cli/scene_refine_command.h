#pragma once

namespace CLI {
class App;
}

namespace nearfit::cli {

/// Adds `scene refine`, which gives shapes of CAD documents another tessellation.
void addSceneRefine(CLI::App& scene);

}  // namespace nearfit::cli
