#include "app/import/result_file.h"

#include <cerrno>
#include <utility>

#include <unistd.h>

namespace nearfit::importer {
namespace {

/// Bytes gathered before a write.
constexpr std::size_t kWrittenAtOnce = std::size_t{1} << 20;

}  // namespace

ResultFile::ResultFile(int descriptor, Error whenFull)
    : descriptor_(descriptor), whenFull_(std::move(whenFull)) {}

void ResultFile::add(std::span<const std::byte> bytes) {
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
  if (pending_.size() >= kWrittenAtOnce) flush();
}

void ResultFile::flush() {
  for (std::span<const std::byte> left = pending_; !left.empty();) {
    const ::ssize_t count = ::write(descriptor_, left.data(), left.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw whenFull_;
    left = left.subspan(static_cast<std::size_t>(count));
  }
  pending_.clear();
}

}  // namespace nearfit::importer
