#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"

namespace nearfit::falcon {

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

/// Bounds on the size of a firmware file, which has some tens of kilobytes [bytes].
constexpr std::size_t kMinFirmware = 256, kMaxFirmware = std::size_t{1} << 20U;

/// Reads the firmware file that the device's maker supplies. Throws DeviceError (NoFirmware) if `file` is
/// empty or its size is out of bounds, FileError if it cannot be read.
/// @param where  Name of the device, for messages.
std::vector<std::byte> readFirmware(const std::filesystem::path& file, const std::string& where);

/// Sets the line as the running firmware uses it and returns true if the firmware
/// answers. Throws DeviceError.
bool isFirmwareRunning(FtdiPort& port);

/// Loads firmware into a device that was just switched on: greets its loader, sends blocks, compares what the
/// loader repeats and checks that the firmware runs. Tries up to kUploads times. Throws DeviceError that says
/// which step failed and what to do; Cancelled.
/// @param where     Name of the device, for messages.
/// @param progress  Fraction of the firmware that the device has repeated.
/// Source: the sequence as libnifalcon documents it.
void uploadFirmware(FtdiPort& port, std::span<const std::byte> firmware, const std::string& where,
                    const ProgressCallback& progress = {});

constexpr int kUploads = 5;

}  // namespace nearfit::falcon
