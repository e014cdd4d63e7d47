#include <QApplication>
#include <QSettings>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "tests/bench/command_program.h"
#include "tests/bench/machine.h"
#include "tests/bench/selection.h"
#include "tests/bench/window/bench_window.h"
#include "tests/bench/window/figures.h"
#include "tests/bench/window/hour.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace nearfit;
using bench::WindowOptions;

/// To add one, add a row.
struct Entry {
  std::string name, description;
  std::function<std::vector<bench::Figure>(const WindowOptions&)> measure;
};

std::vector<Entry> entries() {
  return {
      {"start", "From the program's start to a window that answers", bench::measureStarts},
      {"frames", "Turning a scene while the servo runs, and the servo's lateness", bench::measureFrames},
      {"servo-beside-check", "The servo's lateness while a scene is checked, and without that",
       bench::measureBesideCheck},
      {"servo-beside-report", "The same while reports of a scene are written", bench::measureBesideReport},
      {"idle", "The processor while nothing moves", bench::measureIdle},
      {"glyphs", "What minima add to a picture", bench::measureGlyphs},
      {"picks", "What is under the mouse, of a large mesh", bench::measurePicks},
      {"open", "Whether the window answers while a large mesh is opened", bench::measureOpening},
      {"documents", "The same while CAD documents are opened, and how long until they can be felt",
       bench::measureDocuments},
      {"cancel", "How soon the window is free once that is cancelled", bench::measureCancels},
      {"large", "Many parts with many triangles", bench::measureLarge}};
}

struct CommandOptions {
  std::vector<std::string> names{"all"};
  double seconds = 4.0;
  WindowOptions window;
  std::filesystem::path csv;
};

/// Runs it in a Qt application. Nobody's settings are read or changed.
void withApplication(int argc, char** argv, const std::function<void()>& run) {
  const test::TemporaryFolder settings;
  desktop::Application::prepare();
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope,
                     QString::fromStdString(settings.path().string()));
  const QApplication qt(argc, argv);
  desktop::Application::configure();
  run();
}

void measure(CommandOptions options) {
  options.window.program = std::filesystem::canonical("/proc/self/exe").string();
  options.window.time = std::chrono::milliseconds(static_cast<int>(1e3 * options.seconds));
  const std::string machine = bench::machineComment(options.csv) +
                              fmt::format("# {} turns of {} s\n", options.window.turns, options.seconds);
  fmt::print("{}\n{}", machine, bench::figureTableHeader());
  std::string lines;
  for (const Entry& entry : bench::chosen(entries(), options.names, "--figures")) {
    for (const bench::Figure& figure : entry.measure(options.window)) {
      fmt::print("{}", bench::figureTableLine(figure));
      std::fflush(stdout);
      lines += bench::figureCsvLine(figure);
    }
  }
  if (options.csv.empty()) return;
  atomicWrite(options.csv, machine + fmt::format("# load at end: {}\n", bench::loadAverages()) +
                               bench::figureCsvHeader() + lines);
}

struct HourCommandOptions {
  double minutes = 60.0, every = 60.0;
  std::filesystem::path csv;
};

void measureHour(const HourCommandOptions& options) {
  const bench::HourOptions hour{std::chrono::milliseconds(static_cast<int>(60e3 * options.minutes)),
                                std::chrono::milliseconds(static_cast<int>(1e3 * options.every))};
  const std::string machine =
      bench::machineComment(options.csv) +
      fmt::format("# the demo in the scripted hand for {:g} minutes, a row each {:g} s\n", options.minutes,
                  options.every);
  fmt::print("{}{}", machine, bench::hourCsvHeader());
  std::vector<std::uint64_t> resident;
  std::string lines;
  bench::keepWindowOpen(hour, [&](const bench::HourRow& row) {
    fmt::print("{}", bench::hourCsvLine(row));
    std::fflush(stdout);
    lines += bench::hourCsvLine(row);
    resident.push_back(row.resident);
  });
  const std::int64_t growth = bench::growthOf(resident);
  const std::string end = fmt::format("# growth after the first tenth: {} bytes\n# load at end: {}\n", growth,
                                      bench::loadAverages());
  fmt::print("{}", end);
  if (!options.csv.empty()) atomicWrite(options.csv, machine + end + bench::hourCsvHeader() + lines);
  if (growth > bench::kMaxHourGrowth) {
    throw Error("hour", fmt::format("the window's memory grew by {} bytes", growth),
                fmt::format("find what keeps more than {} bytes", bench::kMaxHourGrowth));
  }
}

void addHour(CLI::App& program, int argc, char** argv) {
  const auto options = std::make_shared<HourCommandOptions>();
  CLI::App* hour = program.add_subcommand(
      "hour", "Memory and lateness with the demo in the scripted hand and its window open; needs a display.");
  hour->add_option("--minutes", options->minutes, "By the wall clock")
      ->check(CLI::Range(0.05, 1440.0))
      ->capture_default_str();
  hour->add_option("--every", options->every, "Seconds of a row")
      ->check(CLI::Range(0.5, 3600.0))
      ->capture_default_str();
  hour->add_option("--csv", options->csv, "File for the table");
  hour->callback([options, argc, argv] { withApplication(argc, argv, [&] { measureHour(*options); }); });
}

void addCommands(CLI::App& program, int argc, char** argv) {
  const auto options = std::make_shared<CommandOptions>();
  CLI::App* figures = program.add_subcommand("figures", "Measures; needs a display, such as xvfb-run's.");
  WindowOptions& window = options->window;
  std::string names = "Which of";
  for (const Entry& entry : entries())
    names += fmt::format(" {} ({});", entry.name, entry.description);
  figures->add_option("--figures", options->names, names)->delimiter(',');
  figures->add_option("--seconds", options->seconds, "Of each turn")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  figures->add_option("--turns", window.turns, "Of each way")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  figures->add_option("--starts", window.starts, "Of the program")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  figures
      ->add_option("--triangles", window.triangles,
                   "Of the scene that is turned, and of the one that is checked")
      ->check(CLI::Range(1000, 100'000'000))
      ->capture_default_str();
  figures
      ->add_option("--million", window.million,
                   "Triangles of the mesh that is opened and picked, and of the assembly")
      ->check(CLI::Range(10'000, 100'000'000))
      ->capture_default_str();
  figures->add_option("--parts", window.parts, "Of the large scene")
      ->check(CLI::Range(8, 100'000))
      ->capture_default_str();
  figures->add_option("--picks", window.picks, "")->check(CLI::Range(20, 10'000'000))->capture_default_str();
  figures
      ->add_option("--shared", window.shared, "Folder of the shared models: adds the vise to the documents")
      ->check(CLI::ExistingDirectory);
  figures
      ->add_option("--instances", window.instances,
                   "Of the assembly that is opened, which has as many triangles as the mesh")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  figures->add_option("--csv", options->csv, "File for the table");
  figures->callback([options, argc, argv] { withApplication(argc, argv, [&] { measure(*options); }); });
  addHour(program, argc, argv);
  CLI::App* start =
      program.add_subcommand("start", "Starts the application, says when it is usable, and ends.");
  start->callback([argc, argv] { (void)bench::startAndLeave(argc, argv); });
}

}  // namespace

int main(int argc, char** argv) {
  const int code = bench::runProgram(
      {"nearfit-bench-window", "Measures the application's window: what a user waits for, and what it costs.",
       "", addCommands},
      argc, argv);
  bench::endProgram(code);
}
