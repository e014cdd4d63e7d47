#include "tests/bench/command_program.h"

#include <cstdio>
#include <exception>

#include <fmt/format.h>

#include "core/base/error.h"

namespace nearfit::bench {

int runCommand(CLI::App& program, int argc, char** argv) {
  constexpr int kFailure = 1, kUsage = 2;
  program.require_subcommand(1);
  try {
    program.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& e) {
    return program.exit(e) == 0 ? 0 : kUsage;
  } catch (const UsageError& e) {
    fmt::print(stderr, "{}: {}\n", program.get_name(), e.what());
    return kUsage;
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}: {}\n", program.get_name(), e.what());
    return kFailure;
  }
}

}  // namespace nearfit::bench
