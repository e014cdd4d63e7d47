#pragma once

namespace CLI {
class App;
}

namespace nearfit::cli {

/// Adds the subcommand `finding` to the command `scene`.
void addSceneFinding(CLI::App& scene);

}  // namespace nearfit::cli
