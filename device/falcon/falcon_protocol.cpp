#include "device/falcon/falcon_protocol.h"

#include <span>

namespace nearfit::falcon {
namespace {

constexpr std::uint8_t kBegin = '<', kEnd = '>', kZero = 'A';
constexpr std::size_t kNumbersAt = 1, kLetters = 4, kFlagsAt = 13;
constexpr std::uint8_t kHomingFlag = 1;

/// Returns std::nullopt if a letter does not stand for four bits.
std::optional<std::int16_t> numberOf(std::span<const std::uint8_t> letters) noexcept {
  unsigned number = 0;
  for (std::size_t i = 0; i < kLetters; ++i) {
    if (letters[i] < kZero || letters[i] > kZero + 15) return std::nullopt;
    number |= static_cast<unsigned>(letters[i] - kZero) << (4U * i);
  }
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(number));
}

std::optional<Report> decode(std::span<const std::uint8_t, kFrameSize> frame) noexcept {
  Report report;
  for (std::size_t i = 0; i < report.encoders.size(); ++i) {
    const auto number = numberOf(frame.subspan(kNumbersAt + kLetters * i, kLetters));
    if (!number) return std::nullopt;
    report.encoders[i] = *number;
  }
  // Unlike the others, this letter carries seven bits.
  if (frame[kFlagsAt] < kZero) return std::nullopt;
  const unsigned flags = frame[kFlagsAt] - unsigned{kZero};
  report.homed = static_cast<std::uint8_t>(flags >> 4U & kAllHomed);
  report.buttons = static_cast<std::uint8_t>(flags & 15U);
  return report;
}

}  // namespace

std::array<std::byte, kFrameSize> encode(const Command& command) noexcept {
  std::array<std::byte, kFrameSize> frame{};
  frame.fill(std::byte{kZero});
  frame.front() = std::byte{kBegin};
  frame.back() = std::byte{kEnd};
  for (std::size_t i = 0; i < command.torques.size(); ++i) {
    const auto bits = static_cast<std::uint16_t>(command.torques[i]);
    for (std::size_t letter = 0; letter < kLetters; ++letter) {
      const unsigned four = static_cast<unsigned>(bits) >> (4U * letter) & 15U;
      frame[kNumbersAt + kLetters * i + letter] = static_cast<std::byte>(kZero + four);
    }
  }
  const unsigned flags = (command.lights & 14U) | (command.isHoming ? kHomingFlag : 0U);
  frame[kFlagsAt] = static_cast<std::byte>(kZero + flags);
  return frame;
}

std::optional<Report> FrameReader::take(std::byte next) noexcept {
  const auto byte = std::to_integer<std::uint8_t>(next);
  if (byte == kBegin) {
    if (size_ != 0) ++damaged_;
    size_ = 0;
  } else if (size_ == 0) {
    return std::nullopt;
  }
  frame_[size_++] = byte;
  if (size_ < kFrameSize && byte != kEnd) return std::nullopt;
  const bool isWhole = size_ == kFrameSize && byte == kEnd;
  size_ = 0;
  const std::optional<Report> report = isWhole ? decode(frame_) : std::nullopt;
  if (!report) ++damaged_;
  return report;
}

}  // namespace nearfit::falcon
