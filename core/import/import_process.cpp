#include "core/import/import_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/files/ownership.h"
#include "core/import/document_file.h"
#include "core/import/import_protocol.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

namespace protocol = import_protocol;
using Clock = std::chrono::steady_clock;

/// Time between two looks at whether the user cancels: short enough to be felt as at once [ms].
constexpr int kLookEveryMs = 20;
/// Time for the importer to say its version: many times what its libraries take to load from a slow disk.
constexpr std::chrono::seconds kVersionTime{10};

/// Words of messages about a program's work.
struct HelperWork {
  const char* program;    ///< Its file.
  const char* variable;   ///< Variable of the environment that names another file.
  const char* missing;    ///< Its name in the message that it is missing.
  const char* name;       ///< "its ... crashed"
  const char* smaller;    ///< Remedy if memory, time or room run out.
  const char* otherwise;  ///< Remedy if it fails for a reason that nobody knows.
};
constexpr HelperWork kImport{protocol::kProgram,
                             "NEARFIT_IMPORT",
                             "the program that reads CAD files is missing",
                             "import",
                             "import a part of it, or choose a coarser tessellation",
                             "the file may be damaged: export it again, or in another format"};
constexpr HelperWork kExport{protocol::kExportProgram,
                             "NEARFIT_EXPORT",
                             "the program that writes CAD files is missing",
                             "export",
                             "export fewer parts, or parts with fewer triangles",
                             "export fewer parts to find the one that fails, or in another format"};

[[noreturn]] void throwSystemError(const std::string& where, const char* problem, int error) {
  throw FileError(where, fmt::format("{}: {}", problem, std::system_category().message(error)),
                  "close other programs and try again");
}

/// A file descriptor that closes itself.
class OwnedDescriptor {
 public:
  OwnedDescriptor() = default;
  explicit OwnedDescriptor(int descriptor) : descriptor_(descriptor) {}
  ~OwnedDescriptor() { reset(); }
  OwnedDescriptor(const OwnedDescriptor&) = delete;
  OwnedDescriptor& operator=(const OwnedDescriptor&) = delete;
  void reset(int descriptor = -1) {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = descriptor;
  }
  int get() const noexcept { return descriptor_; }

 private:
  int descriptor_ = -1;
};

/// The descriptor under a number that none of the child's has, so that giving it one overwrites no other; closes the old.
int movedAside(int descriptor) {
  if (descriptor < 0 || descriptor > protocol::kRequestDescriptor) return descriptor;
  const int moved = ::fcntl(descriptor, F_DUPFD_CLOEXEC, protocol::kRequestDescriptor + 1);
  const int error = errno;
  ::close(descriptor);
  errno = error;
  return moved;
}

/// What a child gets as its open files, and nothing else.
class SpawnActions {
 public:
  SpawnActions() { ::posix_spawn_file_actions_init(&actions_); }
  ~SpawnActions() { ::posix_spawn_file_actions_destroy(&actions_); }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;
  void open(int descriptor, int flags) {
    ::posix_spawn_file_actions_addopen(&actions_, descriptor, "/dev/null", flags, 0);
  }
  void copy(int from, int to) { ::posix_spawn_file_actions_adddup2(&actions_, from, to); }
  void closeFrom(int first) { ::posix_spawn_file_actions_addclosefrom_np(&actions_, first); }
  const ::posix_spawn_file_actions_t* get() const noexcept { return &actions_; }

 private:
  ::posix_spawn_file_actions_t actions_{};
};

/// A process group of its own, and the usual signals whatever this program does with its own.
class SpawnAttributes {
 public:
  SpawnAttributes() {
    ::posix_spawnattr_init(&attributes_);
    ::posix_spawnattr_setflags(&attributes_,
                               POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    ::posix_spawnattr_setpgroup(&attributes_, 0);
    ::sigset_t signals;
    ::sigemptyset(&signals);
    ::posix_spawnattr_setsigmask(&attributes_, &signals);
    ::sigfillset(&signals);
    ::posix_spawnattr_setsigdefault(&attributes_, &signals);
  }
  ~SpawnAttributes() { ::posix_spawnattr_destroy(&attributes_); }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;
  const ::posix_spawnattr_t* get() const noexcept { return &attributes_; }

 private:
  ::posix_spawnattr_t attributes_{};
};

/// The importer's environment: names in UTF-8, and what finds and sets up libraries. Variables of OpenCASCADE could make
/// it read files that nobody opened.
std::vector<std::string> importEnvironment() {
  std::vector<std::string> environment{"LC_ALL=C.UTF-8"};
  for (const char* name :
       {"LD_LIBRARY_PATH", "ASAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS", "LSAN_OPTIONS"})
    if (const char* value = std::getenv(name)) environment.push_back(fmt::format("{}={}", name, value));
  return environment;
}

/// Pointers into the texts, with the null at their end that system calls ask for.
std::vector<char*> pointersTo(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts)
    pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// A running importer or exporter. Its destructor kills it and what it started, and waits for its end.
class ImportChild {
 public:
  /// @param request  -1: it gets none.
  /// @param output   What it prints goes there; -1: nowhere.
  ImportChild(const std::filesystem::path& program, std::vector<std::string> arguments, int result,
              int messages, int request, int output = -1) {
    SpawnActions actions;
    actions.open(0, O_RDONLY);
    actions.open(1, O_WRONLY);
    actions.open(2, O_WRONLY);
    if (output >= 0) actions.copy(output, 1);
    actions.copy(result, protocol::kResultDescriptor);
    actions.copy(messages, protocol::kMessageDescriptor);
    if (request >= 0) actions.copy(request, protocol::kRequestDescriptor);
    actions.closeFrom(request >= 0 ? protocol::kRequestDescriptor + 1 : protocol::kMessageDescriptor + 1);
    std::vector<std::string> environment = importEnvironment();
    const SpawnAttributes attributes;
    const int error = ::posix_spawn(&process_, program.c_str(), actions.get(), attributes.get(),
                                    pointersTo(arguments).data(), pointersTo(environment).data());
    if (error == 0) return;
    process_ = -1;
    throw FileError(program.string(), "it cannot be started: " + std::system_category().message(error),
                    "reinstall Nearfit");
  }
  ~ImportChild() {
    if (process_ > 0) stop();
  }
  ImportChild(const ImportChild&) = delete;
  ImportChild& operator=(const ImportChild&) = delete;

  /// Kills it and returns its status.
  int stop() {
    // What it started is in its group. It cannot leave before its end is waited for, so that the number is still its own.
    ::kill(-process_, SIGKILL);
    ::kill(process_, SIGKILL);
    return wait();
  }
  /// Waits for its end; returns its status as waitpid() does.
  int wait() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
  }
  /// True if it has ended; its status is still to be waited for.
  bool hasEnded() const {
    ::siginfo_t info{};
    return ::waitid(P_PID, static_cast<::id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == process_;
  }

 private:
  ::pid_t process_ = -1;
};

std::vector<std::string_view> fieldsOf(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t end = line.find('\t');
    fields.push_back(line.substr(0, end));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

std::string shown(std::string_view field) {
  return printableText(field.substr(0, protocol::kMaxFieldBytes));
}

/// What the importer says while it works.
class ImportMessages {
 public:
  /// Takes what came through the pipe.
  void take(std::string_view text) {
    pending_ += text;
    for (std::size_t end = 0; (end = pending_.find('\n')) != std::string::npos; pending_.erase(0, end + 1))
      takeLine(std::string_view(pending_).substr(0, end));
    // A line without an end is no message.
    if (pending_.size() > protocol::kMaxLineBytes) pending_.clear();
  }
  double fraction() const noexcept { return fraction_; }
  /// Its own account of why it failed, about `file` if it names no place.
  std::optional<FileError> failure(const std::filesystem::path& file) const {
    if (!hasFailed_) return std::nullopt;
    return FileError(where_.empty() ? file.string() : where_, problem_, remedy_);
  }

 private:
  void takeLine(std::string_view line) {
    const std::vector<std::string_view> fields = fieldsOf(line);
    if (fields[0] == protocol::kProgress && fields.size() == 2) {
      // NaN compares false.
      const double fraction = std::strtod(std::string(fields[1].substr(0, 32)).c_str(), nullptr);
      if (fraction > fraction_) fraction_ = std::min(fraction, 1.0);
    } else if (fields[0] == protocol::kFailure && fields.size() == 4 && !hasFailed_) {
      hasFailed_ = true;
      where_ = shown(fields[1]);
      problem_ = shown(fields[2]);
      remedy_ = shown(fields[3]);
    }
  }

  std::string pending_;
  double fraction_ = 0.0;
  bool hasFailed_ = false;
  std::string where_, problem_, remedy_;
};

/// Reads what is in the pipe; false at its end.
bool takeMessages(int pipe, ImportMessages& messages) {
  std::array<char, 4096> buffer{};
  const ::ssize_t count = ::read(pipe, buffer.data(), buffer.size());
  if (count < 0) return errno == EINTR || errno == EAGAIN;
  messages.take({buffer.data(), static_cast<std::size_t>(count)});
  return count > 0;
}

[[noreturn]] void throwSilent(const std::filesystem::path& file, double seconds, const HelperWork& work) {
  throw FileError(file.string(),
                  fmt::format("its {} made no progress for {:.0f} s and was ended", work.name, seconds),
                  work.otherwise);
}

/// Follows the program until it ends. Throws if it is cancelled or hangs; the child is then still to be stopped.
void follow(const ImportChild& child, int pipe, const std::filesystem::path& file, const ImportLimits& limits,
            const HelperWork& work, const ProgressCallback& progress, ImportMessages& messages) {
  Clock::time_point lastProgress = Clock::now();
  double lastFraction = -1.0;
  // A child of the importer may hold the pipe open for longer than the importer runs.
  for (bool isOpen = true; isOpen && !child.hasEnded();) {
    ::pollfd poll{pipe, POLLIN, 0};
    if (::poll(&poll, 1, kLookEveryMs) > 0) isOpen = takeMessages(pipe, messages);
    if (progress && !progress(messages.fraction())) throw Cancelled();
    const Clock::time_point now = Clock::now();
    if (messages.fraction() > lastFraction) {
      lastFraction = messages.fraction();
      lastProgress = now;
    }
    if (std::chrono::duration<double>(now - lastProgress).count() > limits.silence)
      throwSilent(file, limits.silence, work);
  }
  // It has ended, or closed its end: what is left in the pipe is all there will be.
  ::fcntl(pipe, F_SETFL, O_NONBLOCK);
  std::array<char, 4096> buffer{};
  for (std::size_t total = 0; total < protocol::kMaxLineBytes * 4;) {
    const ::ssize_t count = ::read(pipe, buffer.data(), buffer.size());
    if (count <= 0) break;
    total += static_cast<std::size_t>(count);
    messages.take({buffer.data(), static_cast<std::size_t>(count)});
  }
}

/// Throws FileError if the program ended without a result.
void checkEnd(int status, const ImportMessages& messages, const std::filesystem::path& file,
              const HelperWork& work) {
  const std::string memoryRemedy = fmt::format("{}, or close other programs", work.smaller);
  if (WIFEXITED(status) && WEXITSTATUS(status) == protocol::kDone) return;
  if (const std::optional<FileError> failure = messages.failure(file)) throw *failure;
  if (WIFEXITED(status) && WEXITSTATUS(status) == protocol::kOutOfMemory)
    throw FileError(file.string(), fmt::format("its {} needs more memory than it may have", work.name),
                    memoryRemedy);
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
    throw FileError(file.string(),
                    fmt::format("its {} took too much processor time and was ended", work.name),
                    work.smaller);
  }
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL)
    throw FileError(file.string(),
                    fmt::format("its {} was killed, as the system does when memory runs out", work.name),
                    memoryRemedy);
  throw FileError(file.string(),
                  WIFSIGNALED(status)
                      ? fmt::format("its {} crashed (signal {})", work.name, WTERMSIG(status))
                      : fmt::format("its {} failed (exit code {})", work.name, WEXITSTATUS(status)),
                  work.otherwise);
}

/// All of the result file, whose writer has ended.
std::vector<std::byte> readResult(int descriptor, const std::filesystem::path& file, const HelperWork& work) {
  const auto fail = [&](int error) {
    throwSystemError(file.string(), fmt::format("its {}'s result cannot be read", work.name).c_str(), error);
  };
  struct ::stat status{};
  if (::fstat(descriptor, &status) != 0) fail(errno);
  if (static_cast<std::uint64_t>(status.st_size) > kMaxDocumentBytes)
    throw FileError(file.string(), "it has too many triangles", work.smaller);
  std::vector<std::byte> bytes(static_cast<std::size_t>(status.st_size));
  for (std::size_t done = 0; done < bytes.size();) {
    const ::ssize_t count =
        ::pread(descriptor, bytes.data() + done, bytes.size() - done, static_cast<::off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail(errno);
    done += static_cast<std::size_t>(count);
  }
  return bytes;
}

std::filesystem::path folderOfThisProgram() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  return program.parent_path();
}

void checkProgram(const std::filesystem::path& program, const HelperWork& work) {
  struct ::stat status{};
  if (::stat(program.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) {
    throw FileError(program.string(), work.missing,
                    fmt::format("reinstall Nearfit, or build the target {}", work.program));
  }
  const std::string distrust =
      status.st_uid == 0 && (status.st_mode & (S_IWGRP | S_IWOTH)) == 0 ? std::string() : distrustOf(status);
  if (!distrust.empty())
    throw FileError(program.string(), distrust, "take its ownership, or reinstall Nearfit");
}

std::filesystem::path programOf(const HelperWork& work) {
  // Set by the user alone: as good as the path to the program that it would start.
  if (const char* chosen = std::getenv(work.variable); chosen != nullptr && *chosen != '\0') {
    checkProgram(chosen, work);
    return chosen;
  }
  // Where the build puts it, and where it is once it is installed, whatever the prefix is.
  const std::filesystem::path here = folderOfThisProgram();
  const std::array<std::filesystem::path, 2> places{here / work.program,
                                                    here.parent_path() / "libexec/nearfit" / work.program};
  for (const std::filesystem::path& program : places) {
    struct ::stat status{};
    if (::stat(program.c_str(), &status) == 0 && S_ISREG(status.st_mode)) return program;
  }
  checkProgram(places.front(), work);
  return places.front();
}

/// A file in memory, without a name: nothing is left behind, whatever ends.
int memoryFile(const std::filesystem::path& file, const HelperWork& work) {
  const int descriptor = movedAside(::memfd_create("nearfit-helper", MFD_CLOEXEC));
  if (descriptor < 0)
    throwSystemError(file.string(), fmt::format("there is no memory for its {}", work.name).c_str(), errno);
  return descriptor;
}

void writeRequest(int descriptor, std::span<const std::byte> bytes, const std::filesystem::path& file,
                  const HelperWork& work) {
  while (!bytes.empty()) {
    const ::ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0)
      throwSystemError(file.string(), fmt::format("there is no memory for its {}", work.name).c_str(), errno);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  // The child shares the place to read from.
  ::lseek(descriptor, 0, SEEK_SET);
}

/// @param request  Descriptor; -1: none.
std::vector<std::byte> run(const std::filesystem::path& program, const std::filesystem::path& file,
                           std::vector<std::string> arguments, int request, const HelperWork& work,
                           const ImportLimits& limits, const ProgressCallback& progress) {
  const OwnedDescriptor result(memoryFile(file, work));
  int ends[2] = {-1, -1};
  const std::string unstarted = fmt::format("its {} cannot be started", work.name);
  if (::pipe2(ends, O_CLOEXEC) != 0) throwSystemError(file.string(), unstarted.c_str(), errno);
  const OwnedDescriptor pipe(ends[0]);
  OwnedDescriptor pipeOfChild(movedAside(ends[1]));
  if (pipeOfChild.get() < 0) throwSystemError(file.string(), unstarted.c_str(), errno);
  ImportMessages messages;
  int status = 0;
  {
    ImportChild child(program, std::move(arguments), result.get(), pipeOfChild.get(), request);
    pipeOfChild.reset();
    follow(child, pipe.get(), file, limits, work, progress, messages);
    // One that only closed its end of the pipe is given no more time than one that works.
    const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                     std::chrono::duration<double>(limits.silence));
    while (!child.hasEnded()) {
      if (progress && !progress(messages.fraction())) throw Cancelled();
      if (Clock::now() > end) throwSilent(file, limits.silence, work);
      ::poll(nullptr, 0, kLookEveryMs);
    }
    // Ends also what it may have left running.
    status = child.stop();
  }
  checkEnd(status, messages, file, work);
  return readResult(result.get(), file, work);
}

}  // namespace

std::filesystem::path importProgram() {
  return programOf(kImport);
}

std::filesystem::path exportProgram() {
  return programOf(kExport);
}

std::string importerVersion() {
  const std::filesystem::path program = importProgram();
  const auto fail = [&] {
    throw FileError(program.string(), "it does not say its version", "reinstall Nearfit");
  };
  const OwnedDescriptor output(memoryFile(program, kImport));
  int status = 0;
  {
    ImportChild child(program, {program.string(), "--version"}, output.get(), output.get(), -1, output.get());
    const Clock::time_point end = Clock::now() + kVersionTime;
    while (!child.hasEnded()) {
      if (Clock::now() > end) fail();
      ::poll(nullptr, 0, kLookEveryMs);
    }
    status = child.stop();
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail();
  const std::vector<std::byte> bytes = readResult(output.get(), program, kImport);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t first = text.find('\n');
  const std::size_t second = first == text.npos ? first : text.find('\n', first + 1);
  if (second == text.npos || !text.substr(first + 1).starts_with("OpenCASCADE ")) fail();
  return fmt::format("{}, {}", shown(text.substr(0, first)),
                     shown(text.substr(first + 1, second - first - 1)));
}

std::vector<std::byte> runImporter(const std::filesystem::path& program, const std::filesystem::path& file,
                                   const std::vector<std::string>& arguments, const ImportLimits& limits,
                                   const ProgressCallback& progress) {
  std::vector<std::string> all{program.string(), "--result", fmt::format("{}", protocol::kResultDescriptor),
                               "--messages", fmt::format("{}", protocol::kMessageDescriptor)};
  all.insert(all.end(), arguments.begin(), arguments.end());
  all.insert(all.end(), {"--", file.string()});
  return run(program, file, std::move(all), -1, kImport, limits, progress);
}

std::vector<std::byte> runExporter(const std::filesystem::path& program, const std::filesystem::path& file,
                                   std::span<const std::byte> request, const ImportLimits& limits,
                                   const ProgressCallback& progress) {
  const OwnedDescriptor input(memoryFile(file, kExport));
  writeRequest(input.get(), request, file, kExport);
  return run(program, file, {program.string()}, input.get(), kExport, limits, progress);
}

}  // namespace nearfit
