#include "tests/usb/emulation_options.h"

#include <cstdlib>

namespace nearfit::test {
namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

double number(const char* name) {
  return std::strtod(variable(name).c_str(), nullptr);
}

}  // namespace

void EmulationOptions::toEnvironment() const {
  ::setenv("NEARFIT_EMULATE_KIND", kind.c_str(), 1);
  ::setenv("NEARFIT_EMULATE_PROGRAM", program.c_str(), 1);
  ::setenv("NEARFIT_EMULATE_RATE", std::to_string(rate).c_str(), 1);
  ::setenv("NEARFIT_EMULATE_SECONDS", std::to_string(seconds).c_str(), 1);
  ::setenv("NEARFIT_EMULATE_REPORTS", std::to_string(reports).c_str(), 1);
  ::setenv("NEARFIT_EMULATE_FIRMWARE", firmware.c_str(), 1);
  ::setenv("NEARFIT_EMULATE_UNPLUG", unplug.c_str(), 1);
  ::setenv("NEARFIT_EMULATE_PATH", path.c_str(), 1);
}

EmulationOptions EmulationOptions::fromEnvironment() {
  EmulationOptions options;
  options.kind = variable("NEARFIT_EMULATE_KIND");
  options.program = variable("NEARFIT_EMULATE_PROGRAM");
  options.rate = number("NEARFIT_EMULATE_RATE");
  options.seconds = number("NEARFIT_EMULATE_SECONDS");
  options.reports = static_cast<std::uint64_t>(number("NEARFIT_EMULATE_REPORTS"));
  options.unplug = variable("NEARFIT_EMULATE_UNPLUG");
  options.path = variable("NEARFIT_EMULATE_PATH");
  options.firmware = variable("NEARFIT_EMULATE_FIRMWARE");
  return options;
}

}  // namespace nearfit::test
