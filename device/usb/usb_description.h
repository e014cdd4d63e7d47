#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace nearfit {

enum class UsbTransferType : std::uint8_t { Control, Isochronous, Bulk, Interrupt };

struct UsbEndpoint {
  std::uint8_t address = 0;  ///< As the device gives it: bit 7 set where it sends to the host.
  UsbTransferType type = UsbTransferType::Control;
  std::uint16_t maxPacket = 0;  ///< [bytes]
  double interval = 0.0;        ///< Between two packets, of interrupt endpoints [s]; 0 of others.

  bool isIn() const noexcept { return (address & 0x80U) != 0; }
};

/// Of the first alternate setting.
struct UsbInterface {
  std::uint8_t number = 0, classCode = 0, subclass = 0, protocol = 0;
  std::vector<UsbEndpoint> endpoints;

  /// The first interrupt or bulk endpoint that sends to the host, or takes from it; null where there is none.
  const UsbEndpoint* streaming(bool isIn) const noexcept;
};

/// A device as its descriptors tell it, without its being opened.
struct UsbDescription {
  std::uint16_t vendor = 0, product = 0, release = 0;
  std::uint8_t bus = 0, address = 0;
  std::vector<std::uint8_t>
      ports;  ///< From the root hub on; what stays the same when it is plugged in again.
  std::vector<UsbInterface> interfaces;

  /// "046d:c626".
  std::string id() const;
  /// "/dev/bus/usb/001/002".
  std::string node() const;
  /// "1-4.2": bus and ports.
  std::string place() const;
  const UsbInterface* findInterface(std::uint8_t number) const noexcept;
  /// The same device in the same socket, not plugged in again since.
  bool isSamePlugging(const UsbDescription& other) const noexcept;
};

}  // namespace nearfit
