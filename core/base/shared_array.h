#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace nearfit {

/// Immutable array with shared ownership of its memory: a vector taken over, or a part of a file that was
/// read. Copies share the memory and cost nothing.
template <typename T>
class SharedArray {
 public:
  SharedArray() = default;
  SharedArray(std::vector<T> values) {  // NOLINT(google-explicit-constructor): takes over a finished vector.
    values.shrink_to_fit();
    auto owner = std::make_shared<const std::vector<T>>(std::move(values));
    view_ = *owner;
    keep_ = std::move(owner);
  }
  /// @param keep  Owns the memory of `view`.
  SharedArray(std::span<const T> view, std::shared_ptr<const void> keep)
      : keep_(std::move(keep)), view_(view) {}
  // No moves: a moved-from array would still show memory that it no longer owns.
  SharedArray(const SharedArray&) = default;
  SharedArray& operator=(const SharedArray&) = default;
  ~SharedArray() = default;

  operator std::span<const T>() const noexcept { return view_; }  // NOLINT(google-explicit-constructor)
  std::span<const T> view() const noexcept { return view_; }
  const T& operator[](std::size_t i) const noexcept { return view_[i]; }
  std::size_t size() const noexcept { return view_.size(); }
  bool empty() const noexcept { return view_.empty(); }
  std::size_t byteSize() const noexcept { return view_.size_bytes(); }

 private:
  std::shared_ptr<const void> keep_;
  std::span<const T> view_;
};

}  // namespace nearfit
