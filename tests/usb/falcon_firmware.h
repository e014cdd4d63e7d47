#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace nearfit::test {

/// A Novint Falcon behind its FTDI chip, without hardware: loader, and what its firmware does once it is
/// loaded. Bytes without the chip's status. No thread and no clock.
class FalconFirmware {
 public:
  using Bytes = std::vector<std::byte>;

  /// @param image  The firmware that it runs; anything else that is loaded stays dead.
  explicit FalconFirmware(Bytes image) : image_(std::move(image)) {}

  /// A request to the chip; false: stall.
  bool onRequest(std::uint8_t requestType, std::uint8_t request, std::uint16_t value);
  void onBytes(std::span<const std::byte> bytes);
  /// What waits for the host, at most so many bytes.
  Bytes takeBytes(std::size_t most);
  bool hasBytes() const { return !toHost_.empty(); }

  bool isRunning() const { return state_ == State::Running; }
  /// As if somebody had loaded it before.
  void run() { state_ = State::Running; }
  /// It forgets its firmware, and where its handle is.
  void powerOff();
  /// Of the last whole command.
  const std::array<std::int16_t, 3>& torques() const { return torques_; }
  std::uint8_t lights() const { return lights_; }
  bool isHoming() const { return isHoming_; }
  std::uint64_t commands() const { return commands_; }
  int uploads() const { return uploads_; }

  // What the hand does.
  std::array<std::int16_t, 3> encoders{};
  std::uint8_t buttons = 0;
  std::uint8_t indexesPassed = 0;  ///< Bit i: the hand has moved thigh i past its index.

  // What can go wrong.
  bool isPowered = true;        ///< Else only the chip lives.
  int deafGreetings = 0;        ///< So many are not answered.
  bool hasLeadingZero = false;  ///< Before the loader's answer.
  bool refusesBegin = false;
  std::function<void(Bytes&)> damageNext;  ///< Of its next answer's bytes on their way, once.
  int wrongEchoes = 0;                     ///< In so many uploads the first byte of a block comes back wrong.
  std::size_t mostBytes = SIZE_MAX;        ///< So many it takes of an upload.

 private:
  enum class State { Off, Loader, Loading, Running };
  void setDivisor(std::uint16_t divisor);
  void setDtr(bool isOn);
  void load(std::span<const std::byte> bytes);
  void onFrame();
  void send(std::span<const std::byte> bytes) { toHost_.insert(toHost_.end(), bytes.begin(), bytes.end()); }

  const Bytes image_;
  State state_ = State::Off;
  std::uint16_t divisor_ = 0;
  bool isDtrOn_ = false;
  std::deque<std::byte> toHost_;
  Bytes loaded_;
  int uploads_ = 0;
  std::string greeting_, frame_;
  std::array<std::int16_t, 3> torques_{};
  std::uint8_t lights_ = 0, homed_ = 0;
  bool isHoming_ = false;
  std::uint64_t commands_ = 0;
};

}  // namespace nearfit::test
