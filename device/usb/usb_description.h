#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace nearfit {

enum class UsbTransferType : std::uint8_t { Control, Isochronous, Bulk, Interrupt };

struct UsbEndpoint {
  std::uint8_t address = 0;  ///< Bit 7 is set if it sends to the host.
  UsbTransferType type = UsbTransferType::Control;
  std::uint16_t maxPacket = 0;  ///< [bytes]
  double interval = 0.0;        ///< Interrupt endpoints: time between two packets [s]; others: 0.

  bool isIn() const noexcept { return (address & 0x80U) != 0; }
};

/// An interface in its first alternate setting.
struct UsbInterface {
  std::uint8_t number = 0, classCode = 0, subclass = 0, protocol = 0;
  std::vector<UsbEndpoint> endpoints;

  /// Returns the first interrupt or bulk endpoint that sends to the host (`isIn`) or receives from it;
  /// null if there is none.
  const UsbEndpoint* streaming(bool isIn) const noexcept;
};

/// A device as its descriptors describe it, without opening it.
struct UsbDescription {
  std::uint16_t vendor = 0, product = 0, release = 0;
  std::uint8_t bus = 0, address = 0;
  /// Ports from the root hub on; replugging into the same socket keeps them.
  std::vector<std::uint8_t> ports;
  std::vector<UsbInterface> interfaces;

  /// Returns vendor and product: "046d:c626".
  std::string id() const;
  /// Returns the device node: "/dev/bus/usb/001/002".
  std::string node() const;
  /// Returns bus and ports: "1-4.2".
  std::string place() const;
  /// Returns null if there is none.
  const UsbInterface* findInterface(std::uint8_t number) const noexcept;
  /// True if `other` is the same device in the same socket and it has not been replugged since.
  bool isSamePlugging(const UsbDescription& other) const noexcept;
};

}  // namespace nearfit
