// Readers of CAD documents as a whole: changed documents, imported by nearfit-import as the window does it. Each gives a
// sound document or an Error within the limits of time and memory, and leaves no file and no process. A fuzzer of its
// own, since what it looks for is in another process.
//   fuzz_import_process [--seconds N | --files N] [--seed N] [--first N] [--import PROGRAM] [--findings FOLDER]
//                       FILE_OR_FOLDER...
// The files are the seeds. File `first` and those after it are made of them, for N seconds or N files (30); the same
// numbers make the same files. A file that fails is kept in FOLDER.
#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/import/document_import.h"
#include "core/math/mixed_bits.h"
#include "tests/fuzz/document_changes.h"
#include "tests/fuzz/document_checks.h"
#include "tests/support/run_process.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::fuzz {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Larger seeds take long, and a change in them reaches little.
constexpr std::uintmax_t kMaxSeedBytes = 600'000;

/// Processor time that an import may take [s]: the importer's limits are 120, and 30 for each megabyte, and it ends within
/// 5 of them.
constexpr double kMaxProcessorTime = 200.0;
/// After this an import hangs, however busy the machine is [s]: it is ended after 20 s in which it says nothing new.
constexpr double kHangsAfter = 900.0;
/// Memory that an import may take [KiB]: 2 GiB, 100 bytes for each of the file's, and what libraries are.
constexpr long kMaxResident = 3L << 20;
/// Under sanitizers, which keep what is freed and have no such limit, the machine's is kept by this [MiB].
constexpr int kMaxSanitizedMegabytes = 6144;
/// For what was killed to be gone [s].
constexpr double kMaxReaping = 60.0;

/// Exit code of an importer that a sanitizer has ended: none of its own.
constexpr int kFaultCode = 86;

struct Options {
  double seconds = 0.0;  ///< 0: as many files as `files` says.
  std::uint64_t files = 30;
  std::uint64_t seed = 1, first = 0;
  fs::path program = NEARFIT_IMPORT_PROGRAM;
  fs::path findings;  ///< Empty: nothing is kept.
  std::vector<fs::path> seeds;
};

enum class Outcome { Document, Refused, Ended, Cancelled };

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

::rusage usageOfChildren() {
  ::rusage usage{};
  require(::getrusage(RUSAGE_CHILDREN, &usage) == 0, "the system tells what children took");
  return usage;
}

double processorTime(const ::rusage& usage) {
  const auto seconds = [](const ::timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Waits for what was killed, and requires that nothing else is left. This process gets what its children leave.
void requireNoChildren() {
  const Clock::time_point begin = Clock::now();
  for (;;) {
    const ::pid_t ended = ::waitpid(-1, nullptr, WNOHANG);
    if (ended < 0 && errno == ECHILD) return;
    require(ended >= 0 || errno == EINTR, "the system tells which children there are");
    require(secondsSince(begin) < kMaxReaping, "no process is left behind");
    if (ended == 0) ::usleep(1000);
  }
}

std::vector<std::string> namesIn(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  return names;
}

/// True if a report of a sanitizer is about our code: it names that before a library's. A library that overruns its own
/// memory, or asks for too much, is what the process is there for.
bool isOurs(const std::string& report) {
  // A process that was ended while it reported, as by a user who cancels, says nothing of whose fault it was.
  if (report.find("SUMMARY: ") == report.npos) return false;
  constexpr std::array kMemory{"out of memory", "out-of-memory", "allocation-size-too-big",
                               "hard rss limit exhausted", "failed to allocate"};
  if (std::ranges::any_of(kMemory, [&](const char* text) { return report.find(text) != report.npos; }))
    return false;
  constexpr std::array kLibraries{"libTK",      "lib3mf",     "lib3MF",
                                  "liburdfdom", "libtinyxml", "libconsole_bridge"};
  for (const std::string& line : test::linesOf(report)) {
    if (line.find("    #") == line.npos) continue;
    if (std::ranges::any_of(kLibraries, [&](const char* name) { return line.find(name) != line.npos; }))
      return false;
    if (line.find("nearfit::") != line.npos) return true;
  }
  return true;
}

class ImportFuzzer {
 public:
  explicit ImportFuzzer(Options options)
      : options_(std::move(options)),
        seeds_(documentsIn(options_.seeds, kMaxSeedBytes)),
        isConfined_(test::runProcess({options_.program.string(), "--version"}).out.find("sanitizers") ==
                    std::string::npos),
        program_("NEARFIT_IMPORT", options_.program.string()),
        addressOptions_("ASAN_OPTIONS", sanitizerOptions("ASAN_OPTIONS")),
        undefinedOptions_("UBSAN_OPTIONS", sanitizerOptions("UBSAN_OPTIONS")) {
    for (const fs::path& folder : {in_, work_, reports_})
      fs::create_directory(folder);
    // What an importer writes to the folder it is started in is seen.
    fs::current_path(work_);
  }
  ~ImportFuzzer() {
    std::error_code ignored;
    fs::current_path("/", ignored);
  }
  ImportFuzzer(const ImportFuzzer&) = delete;
  ImportFuzzer& operator=(const ImportFuzzer&) = delete;

  int run() {
    if (seeds_.empty()) {
      std::fprintf(stderr, "fuzz_import_process: there are no documents among the seeds\n");
      return 2;
    }
    for (const DocumentBytes& seed : seeds_)
      tryDocument(packed(seed), seed.name, std::nullopt);
    require(outcomes_[Outcome::Document] > 0, "some seeds are read: else nothing is tried");
    const Clock::time_point begin = Clock::now();
    std::uint64_t index = options_.first;
    const auto isDone = [&] {
      return options_.seconds > 0.0 ? secondsSince(begin) >= options_.seconds
                                    : index - options_.first >= options_.files;
    };
    for (; !isDone(); ++index)
      tryChanged(index);
    tell(index - options_.first);
    return 0;
  }

 private:
  void tryChanged(std::uint64_t index) {
    // A user cancels too, at any time.
    constexpr std::uint64_t kOneIn = 8, kMaxLooks = 64;
    const std::uint64_t chance = mixedBits(mixedBits(~options_.seed) + index);
    const std::optional<std::uint64_t> looks =
        chance % kOneIn == 0 ? std::optional(chance / kOneIn % kMaxLooks) : std::nullopt;
    const DocumentBytes document = changedDocument(seeds_, options_.seed, index);
    tryDocument(document, fmt::format("seed-{}-file-{}", options_.seed, index), looks);
  }

  /// @param name   For people, and of what is kept.
  /// @param looks  How often it may say how far it is before it is cancelled; none: always.
  void tryDocument(const DocumentBytes& document, const std::string& name,
                   std::optional<std::uint64_t> looks) {
    // Before it runs: the last one named is the one that failed.
    std::fprintf(stderr, "%s: %s\n", name.c_str(), document.name.c_str());
    const fs::path kept = keep(document, name);
    const fs::path file = folder_.write(fs::path("in") / document.name, document.bytes);
    const double before = processorTime(usageOfChildren());
    ++outcomes_[outcomeOf(file, looks)];
    requireNoChildren();
    requireNoFaultOfOurs();
    const ::rusage usage = usageOfChildren();
    require(processorTime(usage) - before <= kMaxProcessorTime, "imports end within their processor time");
    require(!isConfined_ || usage.ru_maxrss <= kMaxResident, "imports keep within their memory");
    require(namesIn(work_).empty() && namesIn(in_) == std::vector{file.filename().string()},
            "no file is left behind");
    fs::remove(file);
    if (!kept.empty()) fs::remove(kept);
  }

  /// What is kept until the import is over. A path, or none.
  fs::path keep(const DocumentBytes& document, const std::string& name) const {
    if (options_.findings.empty()) return {};
    fs::create_directories(options_.findings);
    const fs::path file = options_.findings / fmt::format("{}-{}", name, document.name);
    std::ofstream out(file, std::ios::binary);
    out << document.bytes;
    require(static_cast<bool>(out.flush()), "findings can be kept");
    return file;
  }

  Outcome outcomeOf(const fs::path& file, std::optional<std::uint64_t> looks) {
    const Clock::time_point begin = Clock::now();
    double last = 0.0;
    const auto onProgress = [&](double fraction) {
      require(fraction >= last && fraction <= 1.0, "progress grows to 1");
      last = fraction;
      require(secondsSince(begin) < kHangsAfter, "imports end");
      if (!looks) return true;
      return (*looks)-- > 0;
    };
    try {
      requireDocument(importDocument(file, {}, onProgress));
      return Outcome::Document;
    } catch (const Cancelled&) {
      require(looks.has_value(), "only a user cancels");
      return Outcome::Cancelled;
    } catch (const FileError& error) {
      require(!error.problem().empty() && !error.remedy().empty(),
              "an error says what is wrong and what to do");
      require(error.where().find(file.filename().string()) != std::string::npos, "an error names the file");
      return outcomeOf(error);
    }
  }

  /// Tells an importer that refused a file from one that a limit or a fault has ended, and shows the latter.
  static Outcome outcomeOf(const FileError& error) {
    if (!error.problem().starts_with("its import ")) return Outcome::Refused;
    std::fprintf(stderr, "  %s\n", error.problem().c_str());
    return Outcome::Ended;
  }

  void requireNoFaultOfOurs() const {
    for (const std::string& name : namesIn(reports_)) {
      const std::string report = test::readBytes(reports_ / name);
      if (isOurs(report)) {
        std::fprintf(stderr, "%s\n", report.c_str());
        require(false, "our own readers are without fault");
      }
      fs::remove(reports_ / name);
    }
  }

  /// Options of sanitizers besides those that are set: reports go to files, and an exit code tells of them.
  std::string sanitizerOptions(const char* name) const {
    const char *set = std::getenv(name), *symbolizer = std::getenv("ASAN_SYMBOLIZER_PATH");
    std::string options = set == nullptr ? std::string() : std::string(set) + ":";
    options += fmt::format("exitcode={}:log_path={}:hard_rss_limit_mb={}:print_stacktrace=1", kFaultCode,
                           (reports_ / "report").string(), kMaxSanitizedMegabytes);
    if (symbolizer != nullptr) options += fmt::format(":external_symbolizer_path={}", symbolizer);
    return options;
  }

  void tell(std::uint64_t files) {
    const auto count = [&](Outcome outcome) { return outcomes_[outcome]; };
    std::printf(
        "%llu inputs, seed %llu: with %zu seeds %llu documents, %llu refused, %llu ended, %llu cancelled\n",
        static_cast<unsigned long long>(files), static_cast<unsigned long long>(options_.seed), seeds_.size(),
        count(Outcome::Document), count(Outcome::Refused), count(Outcome::Ended), count(Outcome::Cancelled));
  }

  const Options options_;
  const std::vector<DocumentBytes> seeds_;
  const bool isConfined_;
  const test::TemporaryFolder folder_;
  const fs::path in_ = folder_.path() / "in", work_ = folder_.path() / "work",
                 reports_ = folder_.path() / "reports";
  const test::ScopedVariable program_, addressOptions_, undefinedOptions_;
  std::map<Outcome, unsigned long long> outcomes_;
};

std::optional<std::uint64_t> numberIn(std::string_view text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// None if the command line is wrong.
std::optional<Options> optionsOf(std::span<char*> arguments) {
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view argument = arguments[i];
    if (!argument.starts_with("--")) {
      options.seeds.push_back(fs::absolute(argument));
      continue;
    }
    if (++i == arguments.size()) return std::nullopt;
    const std::optional<std::uint64_t> number = numberIn(arguments[i]);
    if (argument == "--import") {
      options.program = fs::absolute(arguments[i]);
    } else if (argument == "--findings") {
      options.findings = fs::absolute(arguments[i]);
    } else if (argument == "--seconds" && number) {
      options.seconds = static_cast<double>(*number);
    } else if (argument == "--files" && number) {
      options.files = *number;
    } else if (argument == "--seed" && number) {
      options.seed = *number;
    } else if (argument == "--first" && number) {
      options.first = *number;
    } else {
      return std::nullopt;
    }
  }
  return options;
}

}  // namespace
}  // namespace nearfit::fuzz

int main(int argc, char** argv) {
  const auto options = nearfit::fuzz::optionsOf(std::span(argv, static_cast<std::size_t>(argc)).subspan(1));
  if (!options || options->seeds.empty()) {
    std::fprintf(stderr,
                 "Usage: %s [--seconds N | --files N] [--seed N] [--first N] [--import PROGRAM] "
                 "[--findings FOLDER] FILE_OR_FOLDER...\n",
                 argv[0]);
    return 2;
  }
  // What the importer starts and leaves comes to this process, and is seen.
  nearfit::fuzz::require(::prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0) == 0, "orphans are taken in");
  return nearfit::fuzz::ImportFuzzer(*options).run();
}
