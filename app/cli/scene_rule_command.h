#pragma once

namespace CLI {
class App;
}

namespace nearfit::cli {

/// Adds the subcommand `rule` to the command `scene`.
void addSceneRule(CLI::App& scene);

}  // namespace nearfit::cli
