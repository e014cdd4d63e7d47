#include "app/import/sandbox.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/landlock.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef NEARFIT_HAS_SECCOMP
#include <seccomp.h>
#endif

#include "core/base/error.h"
#include "core/import/document_file.h"

namespace nearfit::importer {
namespace {

#ifdef NEARFIT_SANITIZED
// Sanitizers reserve terabytes, and look at the process from another one.
constexpr bool kConfines = false;
#else
constexpr bool kConfines = true;
#endif

/// Memory for a small file, and for each byte of a large one: OpenCASCADE takes some 20 to 60 bytes for a byte of STEP
/// until it is meshed. At most a large part of a workstation's.
constexpr std::uint64_t kBaseMemory = std::uint64_t{2} << 30, kMemoryPerByte = 100,
                        kMaxMemory = std::uint64_t{16} << 30;
/// Processor time for a small file, and for each megabyte [s]: some hundred times what files tried here take.
constexpr std::uint64_t kBaseSeconds = 120, kSecondsPerMegabyte = 30, kMaxSeconds = 86'400;
/// Files open at once: the result, messages, and a few to read.
constexpr std::uint64_t kMaxOpenFiles = 64;

void limit(__rlimit_resource resource, std::uint64_t value, std::uint64_t grace = 0) {
  ::rlimit current{};
  if (::getrlimit(resource, &current) != 0) return;
  // An ordinary user cannot raise what is set already.
  const ::rlim_t hard = std::min<::rlim_t>(value + grace, current.rlim_max);
  const ::rlimit wanted{std::min<::rlim_t>(value, hard), hard};
  ::setrlimit(resource, &wanted);
}

std::uint64_t limitOf(__rlimit_resource resource) {
  ::rlimit current{};
  return ::getrlimit(resource, &current) == 0 ? current.rlim_cur : RLIM_INFINITY;
}

std::uint64_t machineBytes() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), bytes = ::sysconf(_SC_PAGESIZE);
  return pages <= 0 || bytes <= 0 ? kMaxMemory
                                  : static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(bytes);
}

/// Memory that a file may take: what its size calls for, and three quarters of the machine's at most.
std::uint64_t memoryFor(std::uint64_t fileBytes) {
  const std::uint64_t wanted = kBaseMemory + std::min(fileBytes, kMaxMemory) * kMemoryPerByte;
  return std::max(kBaseMemory, std::min({wanted, kMaxMemory, machineBytes() / 4 * 3}));
}

long landlockVersion() {
  return ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
}

/// Rights on files that a version of Landlock knows: each version added some to those below it.
std::uint64_t landlockRights(long version) {
  // The first thirteen came with version 1, to refer across folders with 2, to truncate with 3, and to control devices
  // with 5; headers of older systems lack the names.
  std::uint64_t bits = version >= 5 ? 16 : version >= 3 ? 15 : version >= 2 ? 14 : 13;
  return (std::uint64_t{1} << bits) - 1;
}

void allowReading(int ruleset, const std::filesystem::path& path) {
  ::landlock_path_beneath_attr rule{};
  rule.parent_fd = ::open(path.c_str(), O_PATH | O_CLOEXEC);
  if (rule.parent_fd < 0) return;
  std::error_code error;
  rule.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;
  if (std::filesystem::is_directory(path, error)) rule.allowed_access |= LANDLOCK_ACCESS_FS_READ_DIR;
  ::syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
  ::close(rule.parent_fd);
}

void restrictFiles(const std::vector<std::filesystem::path>& readable) {
  const long version = landlockVersion();
  if (version < 1) return;
  ::landlock_ruleset_attr attributes{};
  attributes.handled_access_fs = landlockRights(version);
  const int ruleset = static_cast<int>(
      ::syscall(SYS_landlock_create_ruleset, &attributes, sizeof(attributes.handled_access_fs), 0));
  if (ruleset < 0) return;
  for (const std::filesystem::path& path : readable)
    allowReading(ruleset, path);
  ::syscall(SYS_landlock_restrict_self, ruleset, 0);
  ::close(ruleset);
}

#ifdef NEARFIT_HAS_SECCOMP
/// A filter of system calls; what it does not name fails with EPERM.
class CallFilter {
 public:
  CallFilter() : context_(::seccomp_init(SCMP_ACT_ERRNO(EPERM))) {
    if (context_ == nullptr) fail();
  }
  ~CallFilter() { ::seccomp_release(context_); }
  CallFilter(const CallFilter&) = delete;
  CallFilter& operator=(const CallFilter&) = delete;

  void allow(const char* name) { add(SCMP_ACT_ALLOW, name, {}); }
  /// Allows a call if one of its arguments, masked, has a value.
  void allowIf(const char* name, unsigned argument, std::uint64_t mask, std::uint64_t value) {
    add(SCMP_ACT_ALLOW, name, {{argument, SCMP_CMP_MASKED_EQ, mask, value}});
  }
  /// Lets a call fail as on a kernel that does not know it.
  void deny(const char* name) { add(SCMP_ACT_ERRNO(ENOSYS), name, {}); }
  void load() const {
    if (::seccomp_load(context_) != 0) fail();
  }

 private:
  void add(std::uint32_t action, const char* name, const std::vector<::scmp_arg_cmp>& conditions) {
    const int call = ::seccomp_syscall_resolve_name(name);
    // A name that this library or this processor does not know is that of no call either.
    if (call == __NR_SCMP_ERROR || call < 0) return;
    const int error = ::seccomp_rule_add_array(context_, action, call,
                                               static_cast<unsigned>(conditions.size()), conditions.data());
    if (error != 0) fail();
  }
  [[noreturn]] static void fail() {
    throw Error("sandbox", "system calls cannot be restricted",
                "report this with the version of your kernel");
  }

  ::scmp_filter_ctx context_;
};

/// Memory, threads, time, what is open, and looking at files.
constexpr std::array kAllowedCalls{"brk",
                                   "mmap",
                                   "munmap",
                                   "mremap",
                                   "mprotect",
                                   "madvise",
                                   "membarrier",
                                   "futex",
                                   "futex_time64",
                                   "set_robust_list",
                                   "get_robust_list",
                                   "rseq",
                                   "set_tid_address",
                                   "arch_prctl",
                                   "sched_yield",
                                   "sched_getaffinity",
                                   "sched_getparam",
                                   "sched_getscheduler",
                                   "gettid",
                                   "getpid",
                                   "getppid",
                                   "getuid",
                                   "geteuid",
                                   "getgid",
                                   "getegid",
                                   "tgkill",
                                   "rt_sigaction",
                                   "rt_sigprocmask",
                                   "rt_sigreturn",
                                   "sigaltstack",
                                   "sigreturn",
                                   "restart_syscall",
                                   "exit",
                                   "exit_group",
                                   "clock_gettime",
                                   "clock_gettime64",
                                   "clock_getres",
                                   "clock_nanosleep",
                                   "nanosleep",
                                   "gettimeofday",
                                   "time",
                                   "times",
                                   "getrusage",
                                   "getrlimit",
                                   "ugetrlimit",
                                   "sysinfo",
                                   "uname",
                                   "getrandom",
                                   "read",
                                   "readv",
                                   "pread64",
                                   "preadv",
                                   "write",
                                   "writev",
                                   "pwrite64",
                                   "lseek",
                                   "_llseek",
                                   "close",
                                   "dup",
                                   "fstat",
                                   "fstat64",
                                   "newfstatat",
                                   "fstatat64",
                                   "stat",
                                   "stat64",
                                   "lstat",
                                   "lstat64",
                                   "statx",
                                   "access",
                                   "faccessat",
                                   "faccessat2",
                                   "readlink",
                                   "readlinkat",
                                   "getcwd",
                                   "getdents64",
                                   "getdents",
                                   "poll",
                                   "ppoll",
                                   "memfd_create",
                                   "ftruncate",
                                   "ftruncate64",
                                   "fallocate",
                                   "fadvise64",
                                   "fsync",
                                   "get_mempolicy",
                                   "mincore"};

void restrictCalls() {
  CallFilter filter;
  for (const char* name : kAllowedCalls)
    filter.allow(name);
  // Threads, and no processes. What clone3() asks for lies in memory, where a filter cannot look: without it the C
  // library uses clone().
  filter.allowIf("clone", 0, CLONE_THREAD, CLONE_THREAD);
  filter.deny("clone3");
  // Files are opened for reading only.
  constexpr std::uint64_t kWrites = O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND;
  filter.allowIf("open", 1, kWrites, O_RDONLY);
  filter.allowIf("openat", 2, kWrites, O_RDONLY);
  filter.deny("openat2");
  // Duplicating a descriptor, and reading or setting its flags.
  for (const int command : {F_GETFL, F_SETFL, F_GETFD, F_SETFD, F_DUPFD_CLOEXEC})
    for (const char* name : {"fcntl", "fcntl64"})
      filter.allowIf(name, 1, 0xFFFFFFFFU, static_cast<std::uint64_t>(command));
  filter.load();
}
#endif

}  // namespace

void limitProcess(std::uint64_t fileBytes) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  limit(RLIMIT_CORE, 0);
  const std::uint64_t seconds = std::min(kMaxSeconds, kBaseSeconds + kSecondsPerMegabyte * (fileBytes >> 20));
  limit(RLIMIT_CPU, seconds, 5);
  limit(RLIMIT_FSIZE, std::max(kMaxDocumentBytes, fileBytes));
  limit(RLIMIT_NOFILE, kMaxOpenFiles);
  if (!kConfines) return;
  // What it can write to; the address space may be larger by what libraries and threads only reserve.
  limit(RLIMIT_DATA, memoryFor(fileBytes));
  limit(RLIMIT_AS, 4 * memoryFor(fileBytes));
}

void enterSandbox(const std::vector<std::filesystem::path>& readable) {
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
    throw Error("sandbox", "new privileges cannot be refused", "report this with the version of your kernel");
  if (!kConfines) return;
  restrictFiles(readable);
#ifdef NEARFIT_HAS_SECCOMP
  restrictCalls();
#endif
}

std::string sandboxText() {
  if (!kConfines) return "none, because of sanitizers";
  const long version = landlockVersion();
#ifdef NEARFIT_HAS_SECCOMP
  const std::string calls = "seccomp";
#else
  const std::string calls = "no seccomp, because libseccomp was missing when this was built";
#endif
  return calls +
         (version >= 1 ? fmt::format(", Landlock {}", version) : std::string(", no Landlock in this kernel"));
}

std::string trySandbox() {
  limitProcess(0);
  // In the sandbox nobody may ask for them.
  std::string text = fmt::format("memory: at most {} MiB\nprocessor time: at most {} s\n",
                                 limitOf(RLIMIT_DATA) >> 20, limitOf(RLIMIT_CPU));
  enterSandbox({});
  const auto tell = [&](const char* what, bool isRefused) {
    text += fmt::format("{}: {}\n", what, isRefused ? "refused" : "allowed");
  };
  const auto isRefused = [](int descriptor) {
    if (descriptor >= 0) ::close(descriptor);
    return descriptor < 0;
  };
  tell("network", isRefused(::socket(AF_INET, SOCK_STREAM, 0)));
  tell("local sockets", isRefused(::socket(AF_UNIX, SOCK_STREAM, 0)));
  tell("reading other files", isRefused(::open("/etc/passwd", O_RDONLY | O_CLOEXEC)));
  // Without a name: nothing is left if it is allowed.
  tell("writing files", isRefused(::open("/tmp", O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600)));
  tell("signals to others", ::kill(::getppid(), 0) != 0);
  char program[] = "/bin/true";
  char* const arguments[] = {program, nullptr};
  // A program takes the place of the process that starts it: of a child, if there may be one.
  const ::pid_t child = ::fork();
  if (child == 0) {
    ::execv(program, arguments);
    ::_exit(1);
  }
  int status = 1;
  if (child > 0)
    ::waitpid(child, &status, 0);
  else
    ::execv(program, arguments);
  tell("processes", child < 0);
  tell("programs", status != 0);
  bool hasRun = false;
  std::thread([&] { hasRun = true; }).join();
  tell("threads", !hasRun);
  return text;
}

}  // namespace nearfit::importer
