#include "device/plugins/haply/service_link.h"

#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <optional>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "device/plugins/kit/maker_library.h"

namespace nearfit::haply {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using Tcp = asio::ip::tcp;
using ErrorCode = boost::system::error_code;

constexpr std::uint16_t kUsualPort = 10001;
/// A state of ten devices is some 10 KB; nobody sends more than this by intention.
constexpr std::size_t kMaxMessage = std::size_t{1} << 20;

constexpr const char* kHaplyRemedy =
    "for an Inverse3, install Haply Hub or the Haply Inverse Service, and start it (systemctl start "
    "haply-inverse-service)";

/// Returns the number in a variable of the environment, or `usual` if it is none, 0 or too large.
std::uint16_t positiveIn(const char* variable, std::uint16_t usual) {
  const char* const text = ::secure_getenv(variable);
  if (text == nullptr) return usual;
  std::uint16_t number = 0;
  const auto [end, error] = std::from_chars(text, text + std::strlen(text), number);
  return error == std::errc() && *end == '\0' && number != 0 ? number : usual;
}

}  // namespace

struct ServiceLink::Connection {
  explicit Connection(std::chrono::milliseconds p) : patience(p) {}

  const std::chrono::milliseconds patience;
  asio::io_context context{1};
  beast::websocket::stream<beast::tcp_stream> stream{context};
  beast::flat_buffer buffer;
  std::string text;
  bool isBroken = false;  ///< An operation did not end in time; the stream takes no other.

  /// Starts an operation and waits for its end, `patience` at most. Throws PluginError that says what was not possible.
  template <class Start>
  void await(const char* what, Start&& start) {
    if (isBroken) throw plugin::PluginError(std::string(what) + ": the connection is broken");
    // Shared, since what does not end in time may end only with the context.
    const auto result = std::make_shared<std::optional<ErrorCode>>();
    start([result](const ErrorCode& error, auto&&...) { *result = error; });
    context.restart();
    // The stream's own timer does not end each wait in the middle of a frame; this one ends whatever is waited for.
    context.run_for(patience);
    if (!*result) {
      isBroken = true;
      ErrorCode ignored;
      beast::get_lowest_layer(stream).socket().close(ignored);
      throw plugin::PluginError(std::string(what) + ": no answer in time");
    }
    if (**result) throw plugin::PluginError(std::string(what) + ": " + (*result)->message());
  }
};

ServiceLink::ServiceLink(std::uint16_t port, std::chrono::milliseconds patience)
    : connection_(std::make_unique<Connection>(patience)) {
  Connection& c = *connection_;
  try {
    c.await("no connection", [&](auto done) {
      beast::get_lowest_layer(c.stream).async_connect(Tcp::endpoint(asio::ip::address_v4::loopback(), port),
                                                      std::move(done));
    });
  } catch (const plugin::PluginError&) {
    throw plugin::DriverMissing(kHaplyRemedy);
  }
  ErrorCode ignored;
  // Each message is one small packet, and waits for no other.
  beast::get_lowest_layer(c.stream).socket().set_option(Tcp::no_delay(true), ignored);
  c.stream.read_message_max(kMaxMessage);
  c.await("what listens there is not the Haply Inverse Service", [&](auto done) {
    c.stream.async_handshake("localhost:" + std::to_string(port), "/", std::move(done));
  });
  c.stream.text(true);
}

ServiceLink::~ServiceLink() = default;

void ServiceLink::send(const std::string& text) {
  Connection& c = *connection_;
  c.await("the Haply Inverse Service takes no commands",
          [&](auto done) { c.stream.async_write(asio::buffer(text), std::move(done)); });
}

const std::string& ServiceLink::receive() {
  Connection& c = *connection_;
  c.buffer.clear();
  c.await("the Haply Inverse Service no longer answers",
          [&](auto done) { c.stream.async_read(c.buffer, std::move(done)); });
  const auto bytes = c.buffer.data();
  c.text.assign(static_cast<const char*>(bytes.data()), bytes.size());
  return c.text;
}

std::uint16_t servicePort() {
  return positiveIn("NEARFIT_HAPLY_PORT", kUsualPort);
}

std::chrono::milliseconds servicePatience(std::chrono::milliseconds usual) {
  return std::chrono::milliseconds(
      positiveIn("NEARFIT_HAPLY_PATIENCE", static_cast<std::uint16_t>(usual.count())));
}

}  // namespace nearfit::haply
