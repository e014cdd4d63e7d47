#include "tests/usb/falcon_firmware.h"

#include <algorithm>
#include <utility>

namespace nearfit::test {
namespace {

/// Where the loader greets and loads, and the firmware talks.
constexpr std::uint16_t kGreetingDivisor = 0x4138, kLoadingDivisor = 0x15, kRunningDivisor = 2;

}  // namespace

bool FalconFirmware::onRequest(std::uint8_t requestType, std::uint8_t request, std::uint16_t value) {
  if (requestType != 0x40) return false;
  switch (request) {
    case 0:
      if (value == 1) toHost_.clear();
      return value <= 2;
    case 1:
      if ((value & 0x100) != 0) setDtr((value & 1) != 0);
      return true;
    case 2:
    case 4:
    case 9:
      return true;
    case 3:
      setDivisor(value);
      return true;
    default:
      return false;
  }
}

void FalconFirmware::powerOff() {
  state_ = State::Off;
  isDtrOn_ = false;
  toHost_.clear();
  greeting_.clear();
  frame_.clear();
  torques_ = {};
  homed_ = indexesPassed = 0;
}

void FalconFirmware::setDtr(bool isOn) {
  const bool isReset = isOn && !isDtrOn_;
  isDtrOn_ = isOn;
  if (!isReset || !isPowered) return;
  state_ = State::Loader;
  greeting_.clear();
  homed_ = 0;
}

void FalconFirmware::setDivisor(std::uint16_t divisor) {
  divisor_ = divisor;
  if (divisor == kRunningDivisor && state_ == State::Loading)
    state_ = loaded_ == image_ ? State::Running : State::Off;
}

void FalconFirmware::onBytes(std::span<const std::byte> bytes) {
  if (!isPowered) return;
  if (state_ == State::Loading && divisor_ == kLoadingDivisor) return load(bytes);
  for (const std::byte byte : bytes) {
    const char c = static_cast<char>(byte);
    if (state_ == State::Loader && divisor_ == kGreetingDivisor && isDtrOn_) {
      greeting_ += c;
      if (!greeting_.ends_with("\x0a\x43\x0d")) continue;
      greeting_.clear();
      if (deafGreetings > 0) {
        --deafGreetings;
        continue;
      }
      if (hasLeadingZero) send(std::array{std::byte{0}});
      send(std::as_bytes(std::span("\x0a\x44\x2c\x0d", 4)));
    } else if (state_ == State::Loader && divisor_ == kLoadingDivisor && !isDtrOn_ && c == 'A') {
      if (refusesBegin) continue;
      send(std::array{byte});
      state_ = State::Loading;
      loaded_.clear();
      ++uploads_;
    } else if (state_ == State::Running && divisor_ == kRunningDivisor) {
      frame_ += c;
      if (c == '>') onFrame();
    }
  }
}

void FalconFirmware::load(std::span<const std::byte> bytes) {
  const std::size_t room = mostBytes - std::min(mostBytes, loaded_.size());
  Bytes echo(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(std::min(room, bytes.size())));
  loaded_.insert(loaded_.end(), echo.begin(), echo.end());
  if (wrongEchoes > 0 && !echo.empty()) {
    --wrongEchoes;
    echo.front() ^= std::byte{0x10};
  }
  send(echo);
}

void FalconFirmware::onFrame() {
  const std::string frame = frame_.size() < 16 ? std::string() : frame_.substr(frame_.size() - 16);
  frame_.clear();
  if (frame.empty() || frame.front() != '<') return;
  ++commands_;
  const auto letter = [&](std::size_t i) { return static_cast<unsigned>(frame[i] - 'A'); };
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t at = 1 + 4 * i;
    torques_[i] = static_cast<std::int16_t>(letter(at) + 16 * letter(at + 1) + 256 * letter(at + 2) +
                                            4096 * letter(at + 3));
  }
  isHoming_ = (letter(13) & 1U) != 0;
  lights_ = static_cast<std::uint8_t>(letter(13) & 14U);
  if (isHoming_) homed_ = static_cast<std::uint8_t>(homed_ | indexesPassed);
  std::string answer = "<";
  for (const std::int16_t encoder : encoders) {
    for (unsigned shift = 0; shift < 16; shift += 4)
      answer += static_cast<char>('A' + (static_cast<unsigned>(encoder) >> shift & 15U));
  }
  answer += static_cast<char>('A' + 16 * homed_ + buttons);
  answer += "A>";
  const auto said = std::as_bytes(std::span(answer));
  Bytes bytes(said.begin(), said.end());
  if (damageNext) std::exchange(damageNext, nullptr)(bytes);
  send(bytes);
}

FalconFirmware::Bytes FalconFirmware::takeBytes(std::size_t most) {
  const auto end = toHost_.begin() + static_cast<std::ptrdiff_t>(std::min(most, toHost_.size()));
  Bytes bytes(toHost_.begin(), end);
  toHost_.erase(toHost_.begin(), end);
  return bytes;
}

}  // namespace nearfit::test
