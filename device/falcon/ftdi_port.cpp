#include "device/falcon/ftdi_port.h"

#include <algorithm>

namespace nearfit {
namespace {

enum Request : std::uint8_t {
  kReset = 0,
  kModemControl = 1,
  kFlowControl = 2,
  kBaudRate = 3,
  kData = 4,
  kLatency = 9
};

constexpr std::uint16_t kPurgeIn = 1, kPurgeOut = 2;
constexpr std::uint16_t kEightBits = 8, kNoFlowControl = 0;
/// The upper byte selects the line, the lower one sets it.
constexpr std::uint16_t kDtr = 1, kRts = 2;

std::uint16_t lineSetting(std::uint16_t line, bool isOn) noexcept {
  return static_cast<std::uint16_t>(line << 8U | (isOn ? line : 0U));
}

}  // namespace

void FtdiPort::purge() {
  transport_.control(kReset, kPurgeIn);
  transport_.control(kReset, kPurgeOut);
  rest_ = {};
}

void FtdiPort::setLatency(std::uint8_t ms) {
  transport_.control(kLatency, ms);
}

void FtdiPort::setDivisor(std::uint16_t divisor) {
  transport_.control(kBaudRate, divisor);
}

void FtdiPort::setPlainLine() {
  transport_.control(kData, kEightBits);
  transport_.control(kFlowControl, kNoFlowControl);
}

void FtdiPort::setRts(bool isOn) {
  transport_.control(kModemControl, lineSetting(kRts, isOn));
}

void FtdiPort::setDtr(bool isOn) {
  transport_.control(kModemControl, lineSetting(kDtr, isOn));
}

std::size_t FtdiPort::read(std::span<std::byte> data) {
  std::size_t done = 0;
  for (int empty = 0; done < data.size() && empty < kMaxEmpty;) {
    if (rest_.empty()) rest_ = contentOf(std::span(packet_).first(transport_.read(packet_, kReadTimeout)));
    empty = rest_.empty() ? empty + 1 : 0;
    const std::size_t taken = std::min(rest_.size(), data.size() - done);
    std::copy_n(rest_.begin(), taken, data.begin() + static_cast<std::ptrdiff_t>(done));
    rest_ = rest_.subspan(taken);
    done += taken;
  }
  return done;
}

}  // namespace nearfit
