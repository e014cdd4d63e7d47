#pragma once

namespace CLI {
class App;
}

namespace nearfit::cli {

/// Adds the subcommands `keep` and `release` to the command `scene`.
void addSceneKeep(CLI::App& scene);
void addSceneRelease(CLI::App& scene);

}  // namespace nearfit::cli
