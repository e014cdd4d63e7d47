#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

namespace nearfit::haply {

/// A connection to Haply's Inverse Service: a WebSocket on this computer. The service sends one message when it is
/// opened, and then one for each that it gets (docs.haply.co, WebSocket Protocol). One thread at a time.
class ServiceLink {
 public:
  /// Connects. Throws DriverMissing if nobody listens, PluginError if it is not this service.
  explicit ServiceLink(std::uint16_t port);
  ~ServiceLink();
  ServiceLink(const ServiceLink&) = delete;
  ServiceLink& operator=(const ServiceLink&) = delete;

  /// Sends a text. Throws PluginError if the connection is broken or the service takes nothing for kServicePatience.
  void send(const std::string& text);
  /// Waits for the next message, which is valid until the next call. Throws PluginError as send() does.
  const std::string& receive();

  /// The service answers within a millisecond; without one for so long, Nearfit has stopped the device long before.
  static constexpr std::chrono::milliseconds kServicePatience{500};

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

/// The service's port: 10001, or NEARFIT_HAPLY_PORT if its configuration has another.
std::uint16_t servicePort();

}  // namespace nearfit::haply
