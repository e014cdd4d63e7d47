#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/files/atomic_write.h"
#include "core/scene/part.h"

namespace nearfit {

static_assert(std::endian::native == std::endian::little, "binary files are written as memory has them");

/// Buffers the file's content and reports progress.
class MeshFile {
 public:
  MeshFile(const std::filesystem::path& file, std::uint64_t steps, const ProgressCallback& progress)
      : file_(file), steps_(steps), progress_(progress) {}

  std::string& text() noexcept { return text_; }
  template <class T>
  void append(const T& value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    text_.append(bytes, sizeof(T));
  }
  /// Three bytes: red, green, blue.
  void append(const Colour& colour) {
    for (const float channel : {colour.r, colour.g, colour.b})
      append(static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(channel, 0.0F, 1.0F))));
  }
  /// Call after each vertex or face. Writes and checks for cancellation once per several thousand.
  void step() {
    constexpr std::size_t kBlock = 1 << 18;
    ++done_;
    if (text_.size() < kBlock) return;
    flush();
    if (progress_ && !progress_(static_cast<double>(done_) / static_cast<double>(steps_))) throw Cancelled();
  }
  std::uint64_t commit() {
    flush();
    file_.commit();
    return written_;
  }

 private:
  void flush() {
    file_.write(text_);
    written_ += text_.size();
    text_.clear();
  }

  AtomicFile file_;
  const std::uint64_t steps_;
  const ProgressCallback& progress_;
  std::string text_;
  std::uint64_t done_ = 0, written_ = 0;
};

}  // namespace nearfit
