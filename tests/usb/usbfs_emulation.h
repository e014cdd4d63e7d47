#pragma once

#include <memory>
#include <string>

namespace nearfit::test {

/// What stands behind a path of /dev/bus/usb in place of the kernel.
class UsbfsNode {
 public:
  virtual ~UsbfsNode() = default;
  /// A descriptor that polls as usbfs does, or -1 with errno.
  virtual int open() = 0;
  /// As the system call: -1 with errno.
  virtual int control(int descriptor, unsigned long request, void* argument) = 0;
  /// The descriptor is about to be closed.
  virtual void close(int descriptor) = 0;
};

/// In a program that this is linked into, or that preloads it, open(), ioctl() and close() of these paths go
/// to the nodes; everything else goes on to the system. Inert until the first node is added, since programs
/// open files before their initialisers have run.
void addUsbfsNode(const std::string& path, std::shared_ptr<UsbfsNode> node);
/// What is open of it stays open.
void removeUsbfsNode(const std::string& path);

}  // namespace nearfit::test
