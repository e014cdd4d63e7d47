#pragma once

#include <cstdint>
#include <memory>

#include "tests/makers/standin.h"

namespace nearfit::test {

/// Stands in for Haply's Inverse Service: a WebSocket server on a free port of this computer, which sends the devices when
/// it is connected to, and one state for each message that it gets (docs.haply.co, WebSocket Protocol, 3.5). A force holds
/// for 20 ms, then the device is idle. Models: 0, an Inverse3 with a VerseGrip, format 3.5; 31, the same in format 3.1;
/// 3, an Inverse3 alone. StandinDevice::error: 1, what it sends is no JSON; 2, it names no device; 3, its power is off.
class HaplyStandin {
 public:
  HaplyStandin();
  ~HaplyStandin();
  HaplyStandin(const HaplyStandin&) = delete;
  HaplyStandin& operator=(const HaplyStandin&) = delete;

  std::uint16_t port() const noexcept;
  Standin& devices() noexcept;
  /// Ends as if the service were stopped: connections break, and nobody listens.
  void end();

 private:
  struct Server;
  std::unique_ptr<Server> server_;
};

}  // namespace nearfit::test
