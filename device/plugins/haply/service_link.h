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
  /// @param patience  After which what does not answer counts as gone.
  ServiceLink(std::uint16_t port, std::chrono::milliseconds patience);
  ~ServiceLink();
  ServiceLink(const ServiceLink&) = delete;
  ServiceLink& operator=(const ServiceLink&) = delete;

  /// Sends a text. Throws PluginError if the connection is broken or the service takes nothing in time.
  void send(const std::string& text);
  /// Waits for the next message, which is valid until the next call. Throws PluginError as send() does.
  const std::string& receive();

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

/// The service's port: 10001, or NEARFIT_HAPLY_PORT if its configuration has another.
std::uint16_t servicePort();

/// Returns `usual`, or NEARFIT_HAPLY_PATIENCE [ms] for a computer that is so busy that the service answers later.
std::chrono::milliseconds servicePatience(std::chrono::milliseconds usual);

}  // namespace nearfit::haply
