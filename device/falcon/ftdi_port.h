#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

namespace nearfit {

/// What a port needs of USB. Its calls throw DeviceError.
class FtdiTransport {
 public:
  virtual ~FtdiTransport() = default;
  using Timeout = std::chrono::milliseconds;
  virtual void control(std::uint8_t request, std::uint16_t value) = 0;
  virtual void write(std::span<const std::byte> data) = 0;
  /// One packet of at most FtdiPort::kPacketSize bytes; 0 when none comes in time.
  virtual std::size_t read(std::span<std::byte> packet, Timeout timeout) = 0;
};

/// A serial line behind an FTDI chip: its settings and its bytes. Controlling thread.
/// Source: FTDI's requests as libftdi and the kernel's ftdi_sio document them.
class FtdiPort {
 public:
  static constexpr std::size_t kPacketSize = 64;  ///< Of full-speed USB [bytes].
  static constexpr std::size_t kStatusSize = 2;   ///< Of the line's status, before the bytes of each packet.

  explicit FtdiPort(FtdiTransport& transport) : transport_(transport) {}
  FtdiPort(const FtdiPort&) = delete;
  FtdiPort& operator=(const FtdiPort&) = delete;

  /// Throws away what waits in the chip, both ways, and here.
  void purge();
  /// The chip sends what it has at the latest after so long, be it the status alone.
  void setLatency(std::uint8_t ms);
  /// @param divisor  As the chip takes it: of 3 MHz, with eighths in the upper two bits.
  void setDivisor(std::uint16_t divisor);
  /// Eight bits, no parity, one stop bit, no flow control.
  void setPlainLine();
  void setRts(bool isOn);
  void setDtr(bool isOn);

  void write(std::span<const std::byte> data) { transport_.write(data); }
  /// Reads until `data` is full, or until kMostEmpty packets in a row brought nothing; says how far it came.
  std::size_t read(std::span<std::byte> data);

  /// What a packet brought, without its status.
  static std::span<const std::byte> contentOf(std::span<const std::byte> packet) noexcept {
    return packet.subspan(packet.size() < kStatusSize ? packet.size() : kStatusSize);
  }

 private:
  static constexpr int kMostEmpty = 20;
  /// Longer than the latency that the port is ever set to, so that an empty packet comes in time.
  static constexpr FtdiTransport::Timeout kReadTimeout{25};

  FtdiTransport& transport_;
  std::array<std::byte, kPacketSize> packet_{};
  std::span<const std::byte> rest_;  ///< Of packet_, that nobody has read yet.
};

}  // namespace nearfit
