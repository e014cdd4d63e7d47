#include "device/falcon/falcon_firmware.h"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include "core/files/input_file.h"
#include "device/falcon/falcon_protocol.h"
#include "device/interface/device_error.h"

namespace nearfit::falcon {
namespace {

enum Request : std::uint8_t {
  kReset = 0,
  kModemControl = 1,
  kFlowControl = 2,
  kBaudRate = 3,
  kData = 4,
  kLatency = 9
};

constexpr std::uint16_t kPurgeIn = 1, kPurgeOut = 2;
constexpr std::uint16_t kEightBits = 8, kNoFlowControl = 0;
/// The upper byte selects the line, the lower one sets it.
constexpr std::uint16_t kDtr = 1, kRts = 2;

std::uint16_t lineSetting(std::uint16_t line, bool isOn) noexcept {
  return static_cast<std::uint16_t>(line << 8U | (isOn ? line : 0U));
}

/// Divisors of 3 MHz: the loader greets at 9600 baud and takes data at 3 MHz / 21; the firmware
/// runs at 1.5 MBaud.
constexpr std::uint16_t kGreetingDivisor = 0x4138, kLoadingDivisor = 0x15, kRunningDivisor = 2;
/// With a shorter latency the loader's answers get lost [ms].
constexpr std::uint8_t kLoadingLatency = 16, kRunningLatency = 1;
/// A packet without the chip's status, so that each repeated block is one packet.
constexpr std::size_t kBlockSize = FtdiPort::kPacketSize - FtdiPort::kStatusSize;
constexpr int kGreetings = 20, kQuestions = 10;

constexpr std::array kGreeting{std::byte{0x0a}, std::byte{0x43}, std::byte{0x0d}};
constexpr std::array kAnswer{std::byte{0x0a}, std::byte{0x44}, std::byte{0x2c}, std::byte{0x0d}};
constexpr std::array kStart{std::byte{0x41}};

/// A failed step; it may succeed at the next attempt.
struct Failure {
  std::string problem, remedy;
};

constexpr const char* kPowerCycle =
    "switch the device off at its power supply, wait, switch it on and try again";

/// A zero byte from the chip's reset may come before the answer.
bool isAnswer(std::span<const std::byte> got) {
  if (!got.empty() && got.front() == std::byte{0}) got = got.subspan(1);
  return got.size() >= kAnswer.size() && std::equal(kAnswer.begin(), kAnswer.end(), got.begin());
}

std::optional<Failure> greet(FtdiPort& port) {
  port.purge();
  port.setLatency(kLoadingLatency);
  port.setDivisor(kGreetingDivisor);
  port.setPlainLine();
  port.setRts(false);
  // The edge on DTR resets the processor into its loader.
  port.setDtr(false);
  port.setDtr(true);
  for (int i = 0; i < kGreetings; ++i) {
    port.write(kGreeting);
    std::array<std::byte, kAnswer.size() + 1> got{};
    std::size_t count = port.read(std::span(got).first(kAnswer.size()));
    if (count == kAnswer.size() && got.front() == std::byte{0}) count += port.read(std::span(got).last(1));
    if (isAnswer(std::span(got).first(count))) return std::nullopt;
  }
  return Failure{"its loader does not answer",
                 "check that its power supply is plugged in, then " + std::string(kPowerCycle)};
}

std::optional<Failure> beginLoading(FtdiPort& port) {
  port.setDtr(false);
  port.setDivisor(kLoadingDivisor);
  port.write(kStart);
  std::array<std::byte, kStart.size()> got{};
  if (port.read(got) == got.size() && got == kStart) return std::nullopt;
  return Failure{"its loader does not accept firmware", kPowerCycle};
}

/// Progress over all attempts; never falls.
class Told {
 public:
  explicit Told(const ProgressCallback& progress) : progress_(progress) {}
  void tell(std::size_t done, std::size_t all) {
    max_ = std::max(max_, static_cast<double>(done) / static_cast<double>(all));
    if (progress_ && !progress_(max_)) throw Cancelled();
  }

 private:
  const ProgressCallback& progress_;
  double max_ = 0.0;
};

std::optional<Failure> sendBlocks(FtdiPort& port, std::span<const std::byte> firmware, Told& told) {
  std::array<std::byte, kBlockSize> buffer{};
  for (std::size_t at = 0; at < firmware.size(); at += kBlockSize) {
    told.tell(at, firmware.size());
    const std::span<const std::byte> block = firmware.subspan(at, std::min(kBlockSize, firmware.size() - at));
    port.write(block);
    const std::span<std::byte> echo = std::span(buffer).first(block.size());
    const std::size_t count = port.read(echo);
    if (count < echo.size())
      return Failure{
          fmt::format("it stopped accepting firmware at byte {} of {}", at + count, firmware.size()),
          kPowerCycle};
    const auto wrong = std::mismatch(block.begin(), block.end(), echo.begin()).first;
    if (wrong != block.end()) {
      const std::size_t byte = at + static_cast<std::size_t>(wrong - block.begin());
      return Failure{fmt::format("it echoed byte {} of the firmware incorrectly", byte),
                     "plug it straight into the computer, not into a hub, and try again"};
    }
  }
  return std::nullopt;
}

std::optional<Failure> tryUpload(FtdiPort& port, std::span<const std::byte> firmware, Told& told) {
  if (auto failure = greet(port)) return failure;
  if (auto failure = beginLoading(port)) return failure;
  if (auto failure = sendBlocks(port, firmware, told)) return failure;
  if (isFirmwareRunning(port)) return std::nullopt;
  return Failure{"it accepted the firmware but does not run it",
                 "check that the file is the firmware of the Novint Falcon"};
}

}  // namespace

void FtdiPort::purge() {
  transport_.control(kReset, kPurgeIn);
  transport_.control(kReset, kPurgeOut);
  rest_ = {};
}

void FtdiPort::setLatency(std::uint8_t ms) {
  transport_.control(kLatency, ms);
}

void FtdiPort::setDivisor(std::uint16_t divisor) {
  transport_.control(kBaudRate, divisor);
}

void FtdiPort::setPlainLine() {
  transport_.control(kData, kEightBits);
  transport_.control(kFlowControl, kNoFlowControl);
}

void FtdiPort::setRts(bool isOn) {
  transport_.control(kModemControl, lineSetting(kRts, isOn));
}

void FtdiPort::setDtr(bool isOn) {
  transport_.control(kModemControl, lineSetting(kDtr, isOn));
}

std::size_t FtdiPort::read(std::span<std::byte> data) {
  std::size_t done = 0;
  for (int empty = 0; done < data.size() && empty < kMaxEmpty;) {
    if (rest_.empty()) rest_ = contentOf(std::span(packet_).first(transport_.read(packet_, kReadTimeout)));
    empty = rest_.empty() ? empty + 1 : 0;
    const std::size_t taken = std::min(rest_.size(), data.size() - done);
    std::copy_n(rest_.begin(), taken, data.begin() + static_cast<std::ptrdiff_t>(done));
    rest_ = rest_.subspan(taken);
    done += taken;
  }
  return done;
}

std::vector<std::byte> readFirmware(const std::filesystem::path& file, const std::string& where) {
  if (file.empty()) {
    throw DeviceError(DeviceProblem::NoFirmware, where,
                      "it needs its firmware after it is switched on, and no firmware file is set",
                      "give the firmware file that came with its maker's driver");
  }
  InputFile input(file);
  const std::uint64_t size = input.size();
  if (size < kMinFirmware || size > kMaxFirmware) {
    throw DeviceError(DeviceProblem::NoFirmware, where,
                      fmt::format("{} has {} bytes, but firmware has {} to {}", file.string(), size,
                                  kMinFirmware, kMaxFirmware),
                      "give the firmware file that came with its maker's driver");
  }
  const std::vector<char> content = input.readAll();
  const std::span<const std::byte> bytes = std::as_bytes(std::span(content));
  return {bytes.begin(), bytes.end()};
}

bool isFirmwareRunning(FtdiPort& port) {
  port.setLatency(kRunningLatency);
  port.setDivisor(kRunningDivisor);
  port.purge();
  FrameReader reader;
  for (int i = 0; i < kQuestions; ++i) {
    port.write(encode(Command{}));
    std::array<std::byte, kFrameSize> got{};
    const std::size_t count = port.read(got);
    for (const std::byte byte : std::span(got).first(count)) {
      if (reader.take(byte)) return true;
    }
  }
  return false;
}

void uploadFirmware(FtdiPort& port, std::span<const std::byte> firmware, const std::string& where,
                    const ProgressCallback& progress) {
  Told told(progress);
  std::optional<Failure> failure;
  for (int i = 0; i < kUploads; ++i) {
    failure = tryUpload(port, firmware, told);
    if (!failure) return;
  }
  throw DeviceError(DeviceProblem::NotAnswering, where,
                    fmt::format("{} ({} attempts)", failure->problem, kUploads), failure->remedy);
}

}  // namespace nearfit::falcon
