#include "tests/makers/standin_haply.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <list>
#include <mutex>
#include <string>
#include <thread>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <nlohmann/json.hpp>
#include <sys/socket.h>

namespace nearfit::test {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using Tcp = asio::ip::tcp;
using Stream = beast::websocket::stream<Tcp::socket>;
using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kForceHolds{20};
constexpr std::array kIds = {"05DA", "05DB"};

Json vectorOf(const Triple& v) {
  return {{"x", v[0]}, {"y", v[1]}, {"z", v[2]}};
}

/// Returns a frame of text, as RFC 6455 has it, without the second half of the text.
std::string halfFrame(const std::string& text) {
  // The last frame of a text; no mask; the length follows in 64 bits.
  std::string frame = "\x81\x7f";
  for (int shift = 56; shift >= 0; shift -= 8)
    frame += static_cast<char>((std::uint64_t{text.size()} >> shift) & 0xff);
  return frame + text.substr(0, text.size() / 2);
}

}  // namespace

struct HaplyStandin::Server {
  Standin standin;
  std::atomic<HaplyHang> hangsAt{HaplyHang::Never};
  std::atomic<int> hung{0}, hangs{0};
  asio::io_context context;
  Tcp::acceptor acceptor{context, Tcp::endpoint(asio::ip::address_v4::loopback(), 0)};
  const std::uint16_t port = acceptor.local_endpoint().port();
  std::mutex mutex;  // Of what is below.
  std::list<std::thread> connections;
  std::list<int> sockets;
  std::array<Clock::time_point, 2> last{Clock::now(), Clock::now()}, commanded{};
  bool isOver = false;
  std::thread listener{[this] { listen(); }};

  ~Server() { end(); }
  void end() {
    {
      const std::lock_guard lock(mutex);
      if (isOver) return;
      isOver = true;
      for (const int each : sockets)
        ::shutdown(each, SHUT_RDWR);
    }
    ::shutdown(acceptor.native_handle(), SHUT_RDWR);
    listener.join();
    acceptor.close();
    for (std::thread& each : connections)
      each.join();
  }
  void listen() {
    for (;;) {
      boost::system::error_code error;
      Tcp::socket socket(context);
      acceptor.accept(socket, error);
      const std::lock_guard lock(mutex);
      if (error || isOver) return;
      socket.set_option(Tcp::no_delay(true), error);
      sockets.push_back(socket.native_handle());
      connections.emplace_back([this, s = std::move(socket)]() mutable { serve(std::move(s)); });
    }
  }
  void serve(Tcp::socket socket) {
    const int descriptor = socket.native_handle();
    Stream stream(std::move(socket));
    boost::system::error_code error;
    if (hangsAt == HaplyHang::AtHandshake) error = hangOn(stream);
    if (!error) stream.accept(error);
    stream.text(true);
    if (!error) error = say(stream, state(/*isWhole=*/true));
    while (!error) {
      beast::flat_buffer buffer;
      stream.read(buffer, error);
      if (error) break;
      error = say(stream, take(beast::buffers_to_string(buffer.data())));
    }
    // Before the number is another's.
    const std::lock_guard lock(mutex);
    sockets.remove(descriptor);
    for (StandinDevice& each : standin.devices)
      each.push({}, {});
  }

  /// Sends a message, or as much of it as it is to send. Returns why the connection is over.
  boost::system::error_code say(Stream& stream, const std::string& text) {
    boost::system::error_code error;
    const HaplyHang where = hangsAt;
    switch (where) {
      case HaplyHang::Never:
      case HaplyHang::AtHandshake:
        stream.write(asio::buffer(text), error);
        return error;
      case HaplyHang::AtMessage:
        break;
      case HaplyHang::InFrame:
        asio::write(stream.next_layer(), asio::buffer(halfFrame(text)), error);
        break;
      case HaplyHang::InMessage:
        stream.write_some(/*fin=*/false, asio::buffer(text.substr(0, text.size() / 2)), error);
        break;
    }
    return hangOn(stream);
  }
  /// Returns once the connection is closed, or the service ends.
  boost::system::error_code hangOn(Stream& stream) {
    ++hung;
    ++hangs;
    std::array<char, 256> unheard{};
    boost::system::error_code error;
    while (!error)
      stream.next_layer().read_some(asio::buffer(unheard), error);
    --hung;
    return error;
  }

  std::string take(const std::string& text) {
    for (;;) {
      {
        const std::lock_guard lock(mutex);
        if (isOver || !standin.devices[0].isStalled) break;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const Json message = Json::parse(text);
    {
      const std::lock_guard lock(mutex);
      const bool hasVectors = standin.model != 31;
      for (const Json& each : message.value("inverse3", Json::array())) {
        const std::size_t i = each.at("device_id") == kIds[1] ? 1 : 0;
        const Json force = each.at("commands").at("set_cursor_force").at(hasVectors ? "vector" : "values");
        standin.devices[i].push({force.at("x"), force.at("y"), force.at("z")}, {});
        commanded[i] = Clock::now();
      }
    }
    return state(message.contains("session"));
  }
  std::string state(bool isWhole) {
    const std::lock_guard lock(mutex);
    Json json{{"session_id", 7}, {"inverse3", Json::array()}};
    if (standin.devices[0].error == 1) return "{\"inverse3\": [";
    for (std::size_t i = 0; i < static_cast<std::size_t>(standin.count); ++i) {
      StandinDevice& device = standin.devices[i];
      if (!device.isPlugged || device.error == 2) continue;
      const Clock::time_point now = Clock::now();
      if (now - commanded[i] > kForceHolds) device.push({}, {});
      device.advance(std::chrono::duration<double>(now - last[i]).count());
      last[i] = now;
      Json each{{"device_id", kIds[i]},
                {"state",
                 {{"cursor_position", vectorOf(device.position.get())},
                  {"cursor_velocity", vectorOf(device.velocity.get())}}},
                {"status",
                 {{"calibrated", device.isCalibrated.load()},
                  {"in_use", false},
                  {"power_supply", device.error != 3},
                  {"ready", device.error != 4},
                  {"started", true}}}};
      const Json info = standin.model == 31 ? Json{{"firmware_version", 7}}
                                            : Json{{"major_version", 7}, {"minor_version", 4}};
      if (isWhole) each["config"] = {{"type", "inverse3"}, {"device_info", info}};
      json["inverse3"].push_back(each);
    }
    if (standin.model != 3) {
      const double half = 0.5 * standin.devices[0].turn;
      const int down = standin.devices[0].buttons;
      json["wireless_verse_grip"] = Json::array(
          {{{"device_id", "61576"},
            {"state",
             {{"orientation", {{"w", std::cos(half)}, {"x", 0.0}, {"y", std::sin(half)}, {"z", 0.0}}},
              {"buttons", {{"a", (down & 1) != 0}, {"b", (down & 2) != 0}, {"c", (down & 4) != 0}}}}}}});
    }
    return json.dump();
  }
};

HaplyStandin::HaplyStandin() : server_(std::make_unique<Server>()) {}
HaplyStandin::~HaplyStandin() = default;

std::uint16_t HaplyStandin::port() const noexcept {
  return server_->port;
}
Standin& HaplyStandin::devices() noexcept {
  return server_->standin;
}
void HaplyStandin::hang(HaplyHang where) noexcept {
  server_->hangsAt = where;
}
int HaplyStandin::hung() const noexcept {
  return server_->hung;
}
int HaplyStandin::hangs() const noexcept {
  return server_->hangs;
}
void HaplyStandin::end() {
  server_->end();
}

}  // namespace nearfit::test
