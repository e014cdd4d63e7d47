#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "app/cli/rule_options.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace nearfit::cli {

/// Options of `clearance --all`.
struct SceneCheckOptions {
  std::string threshold, json, csv;
  CLI::Option *jsonOption = nullptr, *csvOption = nullptr;  ///< Given without a file they mean stdout.
  std::optional<std::size_t> minima;
  RuleOptions rules;
  bool isSaved = false;   ///< The findings are kept with the scene.
  bool isStrict = false;  ///< Accepted findings count as others do.
};

/// Adds the options; each needs `all`.
void addSceneCheckOptions(CLI::App& command, CLI::Option& all,
                          const std::shared_ptr<SceneCheckOptions>& options);

/// Checks all pairs of a scene's visible parts and prints what it finds; keeps it in the scene file if asked to. Throws
/// NegativeVerdict if parts clash, no rule allows it and the user has not accepted it as it is; UsageError, FileError,
/// Cancelled (after an interrupt).
void runSceneCheck(const std::string& scene, const SceneCheckOptions& options);

}  // namespace nearfit::cli
