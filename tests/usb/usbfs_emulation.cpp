#include "tests/usb/usbfs_emulation.h"

#include <array>
#include <atomic>
#include <cstdarg>
#include <cstddef>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/types.h>

namespace nearfit::test {
namespace {

/// Descriptors above are never nodes: far more than a test has open.
constexpr std::size_t kMaxDescriptors = 4096;

struct Nodes {
  std::mutex mutex;
  std::map<std::string, std::shared_ptr<UsbfsNode>> byPath;
  std::map<int, std::shared_ptr<UsbfsNode>> open;
};

/// Never destroyed: files are closed after the last destructor of this library.
Nodes& nodes() {
  static Nodes& all = *new Nodes;
  return all;
}

// Constant initialised, since they are asked before any initialiser has run.
std::atomic<bool> isEnabled{false};
std::array<std::atomic<bool>, kMaxDescriptors> isNode{};

bool isOurs(int descriptor) noexcept {
  return descriptor >= 0 && static_cast<std::size_t>(descriptor) < kMaxDescriptors &&
         isNode[static_cast<std::size_t>(descriptor)].load(std::memory_order_acquire);
}

/// The next function of that name behind ours: umockdev's, a sanitizer's or the C library's.
template <typename Function>
Function* next(std::atomic<Function*>& known, const char* name) noexcept {
  Function* function = known.load(std::memory_order_acquire);
  if (function == nullptr) {
    function = reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
    known.store(function, std::memory_order_release);
  }
  return function;
}

std::shared_ptr<UsbfsNode> nodeAt(const char* path) {
  if (!isEnabled.load(std::memory_order_acquire) || path == nullptr) return nullptr;
  // Of other files as little as can be: a sanitizer opens some in the middle of a report, locked.
  if (!std::string_view(path).starts_with("/dev/bus/usb/")) return nullptr;
  const std::lock_guard lock(nodes().mutex);
  const auto found = nodes().byPath.find(path);
  return found == nodes().byPath.end() ? nullptr : found->second;
}

int openNode(const std::shared_ptr<UsbfsNode>& node) {
  const int descriptor = node->open();
  if (descriptor < 0) return descriptor;
  const std::lock_guard lock(nodes().mutex);
  nodes().open[descriptor] = node;
  isNode.at(static_cast<std::size_t>(descriptor)).store(true, std::memory_order_release);
  return descriptor;
}

std::shared_ptr<UsbfsNode> openedAs(int descriptor) {
  const std::lock_guard lock(nodes().mutex);
  const auto found = nodes().open.find(descriptor);
  return found == nodes().open.end() ? nullptr : found->second;
}

void closeNode(int descriptor) {
  std::shared_ptr<UsbfsNode> node = openedAs(descriptor);
  if (!node) return;
  node->close(descriptor);
  const std::lock_guard lock(nodes().mutex);
  nodes().open.erase(descriptor);
  isNode[static_cast<std::size_t>(descriptor)].store(false, std::memory_order_release);
}

using OpenFunction = int(const char*, int, ...);

int openAnything(std::atomic<OpenFunction*>& known, const char* name, const char* path, int flags,
                 mode_t mode) {
  if (const std::shared_ptr<UsbfsNode> node = nodeAt(path)) return openNode(node);
  return next(known, name)(path, flags, mode);
}

std::atomic<OpenFunction*> nextOpen{nullptr}, nextOpen64{nullptr};

/// The mode, where the flags say that there is one.
mode_t modeIn(int flags, std::va_list arguments) {
  const bool hasMode = (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
  return hasMode ? va_arg(arguments, mode_t) : mode_t{0};
}

}  // namespace

void addUsbfsNode(const std::string& path, std::shared_ptr<UsbfsNode> node) {
  const std::lock_guard lock(nodes().mutex);
  nodes().byPath[path] = std::move(node);
  isEnabled.store(true, std::memory_order_release);
}

void removeUsbfsNode(const std::string& path) {
  const std::lock_guard lock(nodes().mutex);
  nodes().byPath.erase(path);
}

}  // namespace nearfit::test

namespace rig = nearfit::test;

// The names of the C library, found before it. Checked calls of fortified programs come as __open_2.
#pragma GCC visibility push(default)
extern "C" {

int open(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = rig::modeIn(flags, arguments);
  va_end(arguments);
  return rig::openAnything(rig::nextOpen, "open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = rig::modeIn(flags, arguments);
  va_end(arguments);
  return rig::openAnything(rig::nextOpen64, "open64", path, flags, mode);
}

// The C library's own names of an open() that it checks. NOLINTNEXTLINE(bugprone-reserved-identifier)
int __open_2(const char* path, int flags) {
  return rig::openAnything(rig::nextOpen, "open", path, flags, 0);
}

// NOLINTNEXTLINE(bugprone-reserved-identifier)
int __open64_2(const char* path, int flags) {
  return rig::openAnything(rig::nextOpen64, "open64", path, flags, 0);
}

int ioctl(int descriptor, unsigned long request, ...) noexcept {
  std::va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  if (rig::isOurs(descriptor)) {
    if (const auto node = rig::openedAs(descriptor)) return node->control(descriptor, request, argument);
  }
  using Function = int(int, unsigned long, ...);
  static constinit std::atomic<Function*> nextIoctl{nullptr};
  return rig::next(nextIoctl, "ioctl")(descriptor, request, argument);
}

int close(int descriptor) {
  if (rig::isOurs(descriptor)) rig::closeNode(descriptor);
  using Function = int(int);
  static constinit std::atomic<Function*> nextClose{nullptr};
  return rig::next(nextClose, "close")(descriptor);
}

}  // extern "C"
#pragma GCC visibility pop
