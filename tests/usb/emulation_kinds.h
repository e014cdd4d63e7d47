#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "tests/usb/emulated_device.h"
#include "tests/usb/emulation_options.h"

namespace nearfit::test {

/// A device of one of the kinds that nearfit-emulate knows, with a hand that moves its handle.
class EmulatedKind {
 public:
  virtual ~EmulatedKind() = default;
  virtual const std::shared_ptr<EmulatedDevice>& device() const = 0;
  /// Reports that the host has taken.
  virtual std::uint64_t sent() = 0;
  /// Once it is plugged in: what is not ends a stream.
  virtual void start() = 0;
  /// Sends nothing more.
  virtual void stop() = 0;
  /// What there is to tell at the end: a line, or several, without the last one's end.
  virtual std::string summary() = 0;
};

/// Throws std::exception when a file that the options name cannot be read.
std::unique_ptr<EmulatedKind> makeKind(const EmulationOptions& options);

}  // namespace nearfit::test
