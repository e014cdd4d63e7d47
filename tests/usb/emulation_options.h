#pragma once

#include <cstdint>
#include <string>

namespace nearfit::test {

/// What nearfit-emulate tells the library that it preloads into a program, through the environment.
struct EmulationOptions {
  std::string kind;           ///< "openhap", "spacemouse", "polhem", "falcon".
  std::string program;        ///< Name of the one that sees the device: shells and wrappers do not.
  double rate = 0.0;          ///< Of reports [Hz]; 0: the device's own.
  double seconds = 0.0;       ///< Till it is unplugged, from when it was first opened [s]; 0: never.
  std::uint64_t reports = 0;  ///< After which it is unplugged; 0: never.
  std::string unplug;         ///< "eproto", "eshutdown", "nodevice".
  std::string path;           ///< CSV of an OpenHap handle's poses, one a report; empty: a slow circle.
  std::string firmware;       ///< What a Falcon runs; empty: it has its firmware already.

  void toEnvironment() const;
  /// Nothing set: `kind` is empty.
  static EmulationOptions fromEnvironment();
};

}  // namespace nearfit::test
