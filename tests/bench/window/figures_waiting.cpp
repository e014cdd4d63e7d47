#include <QApplication>
#include <QDialog>
#include <QDialogButtonBox>
#include <QMetaObject>
#include <QPushButton>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "app/desktop/application.h"
#include "core/base/error.h"
#include "core/recovery/recovery_folder.h"
#include "tests/bench/bench_shapes.h"
#include "tests/bench/instances.h"
#include "tests/bench/portable_random.h"
#include "tests/bench/window/bench_window.h"
#include "tests/bench/window/figures.h"
#include "tests/bench/window/plain_window.h"
#include "tests/support/mesh_files.h"
#include "tests/support/part_geometries.h"
#include "tests/support/run_process.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"
#include "ui/files/document.h"
#include "ui/view3d/view_detail.h"

/// What a user waits for.
namespace nearfit::bench {
namespace {

constexpr double kStartGoal = 1500.0, kPickGoal = 5.0, kAnswerGoal = 100.0, kCancelGoal = 200.0;  ///< [ms]

std::uint32_t frequencyOf(std::size_t triangles) {
  return static_cast<std::uint32_t>(
      std::max(1.0, std::round(std::sqrt(static_cast<double>(triangles) / 20.0))));
}

Scene sceneOf(std::span<const PartGeometryPtr> geometries, std::size_t parts) {
  return gridOf(geometries, parts);
}

Figure answersOf(const char* name, std::string way, const Heartbeat& heart, std::string remark) {
  Figure figure = figureOf(name, std::move(way), "ms", heart.waits);
  figure.goal = kAnswerGoal;
  figure.goalOf = "max";
  figure.remark = std::move(remark);
  return figure;
}

}  // namespace

int startAndLeave(int argc, char** argv) {
  desktop::requireDisplay();
  desktop::Application::prepare();
  QApplication qt(argc, argv);
  desktop::Application::configure();
  desktop::requireOpenGl();
  desktop::Application application;
  const std::filesystem::path recovery = userRecoveryFolder();
  if (!recovery.empty()) application.window().protectWork(recovery);
  application.window().show();
  QObject::connect(&application.window().viewport(), &QOpenGLWidget::frameSwapped, &application, [&] {
    // What came before it has been handled: it answers.
    QMetaObject::invokeMethod(
        &application,
        [] {
          std::puts("usable");
          std::fflush(stdout);
          std::_Exit(0);
        },
        Qt::QueuedConnection);
  });
  return QApplication::exec();
}

std::vector<Figure> measureStarts(const WindowOptions& options) {
  const test::TemporaryFolder home;
  // As of a user who has just got it, and no other's work to recover.
  const test::ScopedVariable config("XDG_CONFIG_HOME", home.path().string()),
      state("XDG_STATE_HOME", home.path().string()), data("XDG_DATA_HOME", home.path().string());
  std::vector<double> starts;
  for (std::size_t i = 0; i < options.starts; ++i) {
    const double start = milliseconds();
    const test::ProcessResult result = test::runProcess({options.program, "start"});
    if (result.exitCode != 0) throw Error("start", result.err, "run " + options.program + " start");
    starts.push_back(milliseconds() - start);
  }
  Figure figure = figureOf("start", "until it has drawn and answers", "ms", starts);
  figure.goal = kStartGoal;
  figure.goalOf = "p50";
  return {figure};
}

std::vector<Figure> measurePicks(const WindowOptions& options) {
  BenchWindow window;
  const std::array geometries{test::freshGeometryOf(organicMesh(frequencyOf(options.million), 1))};
  const Scene scene = sceneOf(geometries, 1);
  window.open(scene);
  PlainWindow plain(scene);
  std::mt19937_64 random(1);
  std::vector<double> ours, others;
  std::size_t hits = 0;
  for (std::size_t i = 0; i < options.picks; ++i) {
    const QPoint at(static_cast<int>(uniform(random) * window.view().width()),
                    static_cast<int>(uniform(random) * window.view().height()));
    double start = milliseconds();
    hits += window.view().pointAt(at) ? 1 : 0;
    ours.push_back(milliseconds() - start);
    if (i >= options.picks / 20) continue;
    start = milliseconds();
    plain.pickAt(at);
    others.push_back(milliseconds() - start);
  }
  Figure figure = figureOf("pick", fmt::format("{} triangles", trianglesOf(scene)), "ms", ours);
  figure.goal = kPickGoal;
  figure.goalOf = "p99";
  figure.remark = fmt::format("{} of them meet the mesh", hits);
  return {figure, figureOf("pick", "vtkCellPicker without a locator", "ms", others)};
}

std::vector<Figure> measureOpening(const WindowOptions& options) {
  const test::ScopedVariable noCache("NEARFIT_CACHE", "off");
  const test::TemporaryFolder folder;
  const std::filesystem::path file =
      folder.write("large.stl", test::stlBinary(organicMesh(frequencyOf(options.million), 1)));
  BenchWindow window;
  bool isLoaded = false;
  ui::Document& document = window.application().window().document();
  QObject::connect(&document, &ui::Document::loaded, &window.application(), [&] { isLoaded = true; });
  const double start = milliseconds();
  const Heartbeat heart;
  document.addParts({QString::fromStdString(file.string())}, 1.0);
  waitUntil("the mesh", [&] { return isLoaded; });
  const double loaded = milliseconds() - start;
  window.settle();
  const std::string remark = fmt::format("loaded in {:.1f} s; {} in the last picture", loaded / 1e3,
                                         window.view().detail().detail().isFull ? "all" : "not all");
  const std::string way =
      fmt::format("an event's wait; {} triangles", trianglesOf(window.application().session().scene()));
  return {answersOf("open", way, heart, remark)};
}

std::vector<Figure> measureCancels(const WindowOptions& options) {
  constexpr std::size_t kCancels = 24;
  const test::ScopedVariable noCache("NEARFIT_CACHE", "off");
  const test::TemporaryFolder folder;
  const std::filesystem::path file =
      folder.write("large.stl", test::stlBinary(organicMesh(frequencyOf(options.million), 1)));
  std::vector<double> taken;
  double whole = 0.0;
  // Once to its end, which tells how long there is to cancel it; then at any time of it.
  for (std::size_t i = 0; i <= kCancels; ++i) {
    BenchWindow window;
    ui::Document& document = window.application().window().document();
    std::optional<bool> isComplete;
    QObject::connect(&document, &ui::Document::loaded, &window.application(),
                     [&](bool isAll) { isComplete = isAll; });
    const double start = milliseconds();
    document.addParts({QString::fromStdString(file.string())}, 1.0);
    const auto* dialog = window.application().window().findChild<QDialog*>(QStringLiteral("progressDialog"));
    if (dialog == nullptr) throw Error("cancel", "nothing shows the progress");
    const double when = i == 0 ? 1e9 : whole * (static_cast<double>(i) - 0.5) / kCancels;
    waitUntil("the mesh", [&] { return isComplete || milliseconds() - start >= when; });
    if (isComplete) {
      // The first is slower than those after it.
      whole = i == 0 ? milliseconds() - start : std::min(whole, milliseconds() - start);
      continue;
    }
    const double cancelled = milliseconds();
    dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Cancel)->click();
    waitUntil("the cancel", [&] { return isComplete && !document.isBusy(); });
    taken.push_back(milliseconds() - cancelled);
  }
  if (taken.empty())
    throw Error("cancel", "the mesh is opened before it can be cancelled", "take a larger one");
  Figure figure = figureOf("cancel", fmt::format("opening {} triangles", options.million), "ms", taken);
  figure.goal = kCancelGoal;
  figure.goalOf = "max";
  figure.remark = fmt::format("at any time of {:.1f} s", whole / 1e3);
  return {figure};
}

std::vector<Figure> measureLarge(const WindowOptions& options) {
  std::vector<PartGeometryPtr> geometries;
  for (std::uint64_t seed = 1; seed <= 8; ++seed)
    geometries.push_back(test::freshGeometryOf(organicMesh(frequencyOf(options.million / 100), seed)));
  const Scene scene = sceneOf(geometries, options.parts);
  BenchWindow window;
  window.open(scene);
  const std::size_t all = trianglesOf(scene);
  const Heartbeat heart;
  Figure frames =
      figureOf("large", fmt::format("frame; {} parts", options.parts), "ms", window.orbit(options.time));
  frames.remark = fmt::format("{} of {} triangles a picture", window.view().detail().detail().triangles, all);
  const double stopped = milliseconds();
  window.settle();
  const ui::PictureDetail& detail = window.view().detail().detail();
  const std::string whole = fmt::format(
      "at rest after {:.1f} s: {}", (milliseconds() - stopped) / 1e3,
      detail.isFull ? "all is drawn" : fmt::format("{} triangles of what shines through", detail.triangles));
  Figure answers = answersOf("large", "an event's wait", heart, whole);
  window.view().detail().setBudget(kWholeScene * all);
  Figure full = figureOf("large", "frame; full detail", "ms", window.orbit(options.time));
  full.remark = fmt::format("{} of {} triangles a picture", window.view().detail().detail().triangles, all);
  PlainWindow plain(scene);
  return {frames, answers, full, figureOf("large", "frame; plain VTK", "ms", plain.orbit(options.time))};
}

}  // namespace nearfit::bench
