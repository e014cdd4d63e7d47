#pragma once

#include <cstdint>
#include <memory>

#include "tests/makers/standin.h"

namespace nearfit::test {

/// Where the service stops talking. It keeps the connection, and takes no notice of what arrives.
enum class HaplyHang {
  Never,
  AtHandshake,  ///< New connections are accepted, and nothing is said; others go on.
  AtMessage,    ///< It sends no message.
  InFrame,      ///< It sends a frame's header and half of what the header announces.
  InMessage,    ///< It sends a message's first frame, and not its last.
};

/// Stands in for Haply's Inverse Service: a WebSocket server on a free port of this computer, which sends the devices when
/// it is connected to, and one state for each message that it gets (docs.haply.co, WebSocket Protocol, 3.5). A force holds
/// for 20 ms, then the device is idle. Models: 0, an Inverse3 with a VerseGrip, format 3.5; 31, the same in format 3.1;
/// 3, an Inverse3 alone. StandinDevice::error: 1, what it sends is no JSON; 2, it names no device; 3, its power is off; 4, it
/// is not ready.
class HaplyStandin {
 public:
  HaplyStandin();
  ~HaplyStandin();
  HaplyStandin(const HaplyStandin&) = delete;
  HaplyStandin& operator=(const HaplyStandin&) = delete;

  std::uint16_t port() const noexcept;
  Standin& devices() noexcept;
  /// Connections hang from now on when they come to that place. Those that hang do so until Nearfit closes them.
  void hang(HaplyHang where) noexcept;
  /// Returns how many connections hang now, and how many ever did.
  int hung() const noexcept;
  int hangs() const noexcept;
  /// Ends as if the service were stopped: connections break, and nobody listens.
  void end();

 private:
  struct Server;
  std::unique_ptr<Server> server_;
};

}  // namespace nearfit::test
