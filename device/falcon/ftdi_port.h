#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

namespace nearfit {

/// The USB side of a port. Its calls throw DeviceError.
class FtdiTransport {
 public:
  virtual ~FtdiTransport() = default;
  using Timeout = std::chrono::milliseconds;
  /// Sends a vendor request.
  virtual void control(std::uint8_t request, std::uint16_t value) = 0;
  /// Sends all of `data`.
  virtual void write(std::span<const std::byte> data) = 0;
  /// Reads one packet of at most FtdiPort::kPacketSize bytes. Returns its size; 0 if none comes in time.
  virtual std::size_t read(std::span<std::byte> packet, Timeout timeout) = 0;
};

/// A serial line behind an FTDI chip: its settings and its bytes. Controlling thread. Throws as
/// its transport does.
/// Source: FTDI's requests as libftdi and the kernel's ftdi_sio document them.
class FtdiPort {
 public:
  static constexpr std::size_t kPacketSize = 64;  ///< Full-speed USB [bytes].
  static constexpr std::size_t kStatusSize = 2;   ///< Line status ahead of each packet's content [bytes].

  explicit FtdiPort(FtdiTransport& transport) : transport_(transport) {}
  FtdiPort(const FtdiPort&) = delete;
  FtdiPort& operator=(const FtdiPort&) = delete;

  /// Discards the bytes that wait here and in the chip, both ways.
  void purge();
  /// Sets how long the chip waits at most before it sends what it has, even if only its status.
  void setLatency(std::uint8_t ms);
  /// @param divisor  Divisor of 3 MHz as the chip takes it, with eighths in the upper two bits.
  void setDivisor(std::uint16_t divisor);
  /// Sets eight bits, no parity, one stop bit, no flow control.
  void setPlainLine();
  void setRts(bool isOn);
  void setDtr(bool isOn);

  void write(std::span<const std::byte> data) { transport_.write(data); }
  /// Reads until `data` is full, or until kMaxEmpty packets in a row were empty. Returns the
  /// number of bytes read.
  std::size_t read(std::span<std::byte> data);

  /// Returns a packet's content, without its status.
  static std::span<const std::byte> contentOf(std::span<const std::byte> packet) noexcept {
    return packet.subspan(packet.size() < kStatusSize ? packet.size() : kStatusSize);
  }

 private:
  static constexpr int kMaxEmpty = 20;
  /// Longer than any latency set here, so that an empty packet comes in time.
  static constexpr FtdiTransport::Timeout kReadTimeout{25};

  FtdiTransport& transport_;
  std::array<std::byte, kPacketSize> packet_{};
  std::span<const std::byte> rest_;  ///< Unread part of packet_.
};

}  // namespace nearfit
