#include <atomic>
#include <cmath>
#include <ctime>
#include <functional>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/parallel/low_priority.h"
#include "core/report/html/fit_report.h"
#include "core/verdict/scene_check.h"
#include "device/servo/servo_loop.h"
#include "tests/bench/bench_shapes.h"
#include "tests/bench/instances.h"
#include "tests/bench/statistics.h"
#include "tests/bench/window/bench_window.h"
#include "tests/bench/window/figures.h"
#include "tests/bench/window/plain_window.h"
#include "tests/support/part_geometries.h"
#include "tests/support/temporary_folder.h"
#include "ui/view3d/view_detail.h"

/// Frames and what runs beside them.
namespace nearfit::bench {
namespace {

constexpr double kFrameGoal = 50.0;  ///< Twenty a second [ms].
constexpr double kLatenessFactor = 1.5;
constexpr double kGlyphGoal = 3.0, kIdleGoal = 1.0;
constexpr std::size_t kMinima = 100;
/// Of checks and reports beside the servo [m].
constexpr double kBesideThreshold = 0.1;

std::uint32_t frequencyOf(std::size_t triangles) {
  return static_cast<std::uint32_t>(
      std::max(1.0, std::round(std::sqrt(static_cast<double>(triangles) / 20.0))));
}

/// Two scans of half of the triangles each; the first is in hand.
Scene pairOf(std::size_t triangles) {
  const std::array geometries{
      test::freshGeometryOf(organicMesh(frequencyOf(triangles / 2), 1), glm::dvec3(0.0)),
      test::freshGeometryOf(organicMesh(frequencyOf(triangles / 2), 2), glm::dvec3(0.0))};
  Scene scene = gridOf(geometries, 2);
  return scene;
}

Figure latenessOf(std::string name, std::string way, const std::vector<ServoStatistics>& turns) {
  const auto middle = [&](double fraction) {
    std::vector<double> values;
    for (const ServoStatistics& turn : turns)
      values.push_back(1e6 * turn.lateness.percentile(fraction));
    return SampleSummary(values).percentile(0.5);
  };
  Figure figure{std::move(name), std::move(way), "us"};
  figure.leftOut = 0;
  for (const ServoStatistics& turn : turns) {
    *figure.leftOut += turn.overruns;
    figure.count += turn.lateness.count();
    figure.max = std::max(figure.max, 1e6 * turn.lateness.max());
  }
  figure.p50 = middle(0.5);
  figure.p99 = middle(0.99);
  figure.p999 = middle(0.999);
  figure.remark = "percentiles: the median turn's";
  return figure;
}

double processorSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Sets the goals: p99 and p99.9 of lateness within a factor of those without, and no more ticks left out.
void setGoals(Figure& with, const Figure& without) {
  with.goal = kLatenessFactor * without.p99;
  with.goalOf = "p99";
  with.goalP999 = kLatenessFactor * without.p999;
  with.maxLeftOut = without.leftOut;
}

/// Pictures of one way to draw. What the processors do for each tells beside load too what it costs.
class Frames {
 public:
  explicit Frames(std::string way) : way_(std::move(way)) {}

  std::string remark;

  void add(const std::function<std::vector<double>()>& draw) {
    const double before = processorSeconds();
    const std::vector<double> some = draw();
    busy_ += processorSeconds() - before;
    times_.insert(times_.end(), some.begin(), some.end());
  }
  Figure figure(double goal) const {
    Figure figure = figureOf("frame", way_, "ms", times_);
    figure.goal = goal;
    if (goal > 0.0) figure.goalOf = "p50";
    figure.remark = fmt::format("{}{}{:.1f} ms of the processors each", remark, remark.empty() ? "" : "; ",
                                1e3 * busy_ / static_cast<double>(times_.size()));
    return figure;
  }

 private:
  std::string way_;
  std::vector<double> times_;
  double busy_ = 0.0;
};

/// A row of scans, each of which clashes with its neighbours: work of all kinds for a check, for as long as wanted.
Scene clashingRow(std::size_t triangles) {
  constexpr std::size_t kParts = 8;
  constexpr double kSpacing = 0.8;
  Scene scene;
  for (std::size_t i = 0; i < kParts; ++i)
    scene.add(test::partOf(test::geometryOf(organicMesh(frequencyOf(triangles / kParts), i + 1)),
                           fmt::format("scan {}", i + 1).c_str(),
                           {{1, 0, 0, 0}, {kSpacing * static_cast<double>(i), 0.0, 0.0}}));
  return scene;
}

/// Checks a scene again and again, as the window does it, while it lives.
class ChecksBeside {
 public:
  explicit ChecksBeside(const Scene& scene) : request_(sceneCheckRequest(scene, kBesideThreshold)) {
    request_.isLowPriority = true;
    thread_ = std::thread([this] { run(); });
  }
  ~ChecksBeside() {
    isOver_ = true;
    thread_.join();
  }
  ChecksBeside(const ChecksBeside&) = delete;
  ChecksBeside& operator=(const ChecksBeside&) = delete;

 private:
  void run() {
    try {
      while (!isOver_)
        (void)checkScene(request_, [this](double) { return !isOver_; });
    } catch (const Cancelled&) {
      // The measurement has ended.
    }
  }

  SceneCheckRequest request_;
  std::atomic<bool> isOver_{false};
  std::thread thread_;
};

/// Writes reports of a scene again and again, as the window does it, while it lives.
class ReportsBeside {
 public:
  explicit ReportsBeside(const Scene& scene) : request_(fitReportRequest(scene, {}, {}, kBesideThreshold)) {
    thread_ = std::thread([this] { run(); });
  }
  ~ReportsBeside() {
    isOver_ = true;
    thread_.join();
  }
  ReportsBeside(const ReportsBeside&) = delete;
  ReportsBeside& operator=(const ReportsBeside&) = delete;

 private:
  void run() {
    lowerThreadPriority();
    try {
      while (!isOver_)
        (void)writeFitReport(request_, folder_.path() / "report.html", [this](double) { return !isOver_; });
    } catch (const Cancelled&) {
      // The measurement has ended.
    }
  }

  test::TemporaryFolder folder_;
  FitReportRequest request_;
  std::atomic<bool> isOver_{false};
  std::thread thread_;
};

/// The servo's lateness with a worker beside it, and in turns without.
/// @tparam Beside  Works on a scene for as long as it lives.
template <class Beside>
std::vector<Figure> measureBeside(const WindowOptions& options, const std::string& name, const char* way,
                                  const char* what) {
  const Scene worked = clashingRow(options.triangles);
  BenchWindow window;
  window.open(pairOf(options.triangles));
  std::vector<ServoStatistics> beside, alone;
  double busy = 0.0;
  for (std::size_t turn = 0; turn < options.turns; ++turn) {
    // The window neither draws nor looks at the servo, in either way.
    window.startServo();
    std::this_thread::sleep_for(options.time);
    window.stopServo();
    alone.push_back(window.application().servo().statistics());
    window.startServo();
    {
      const double before = processorSeconds();
      const Beside worker(worked);
      std::this_thread::sleep_for(options.time);
      busy += processorSeconds() - before;
      window.stopServo();
    }
    beside.push_back(window.application().servo().statistics());
  }
  Figure with = latenessOf(name, way, beside), without = latenessOf(name, "without", alone);
  setGoals(with, without);
  const double seconds =
      1e-3 * static_cast<double>(options.time.count()) * static_cast<double>(options.turns);
  with.remark +=
      fmt::format("; {:.2f} processors busy; {} triangles {}", busy / seconds, trianglesOf(worked), what);
  return {with, without};
}

std::string detailText(BenchWindow& window) {
  return fmt::format("{} triangles a picture", window.view().detail().detail().triangles);
}

}  // namespace

std::vector<Figure> measureFrames(const WindowOptions& options) {
  const Scene scene = pairOf(options.triangles);
  BenchWindow window;
  window.open(scene);
  Frames large(fmt::format("{} triangles; servo runs", trianglesOf(scene))),
      small("the same; window of 1280 x 800");
  Frames full("full detail; servo runs"), plain("plain VTK; no servo");
  std::vector<ServoStatistics> with, without;
  for (std::size_t turn = 0; turn < options.turns; ++turn) {
    window.startServo();
    large.add([&] { return window.orbit(options.time); });
    large.remark = detailText(window);
    window.stopServo();
    with.push_back(window.application().servo().statistics());
    window.startServo();
    // The window neither draws nor looks at the servo.
    std::this_thread::sleep_for(options.time);
    window.stopServo();
    without.push_back(window.application().servo().statistics());
    window.resize(Sized::Window);
    window.startServo();
    small.add([&] { return window.orbit(options.time); });
    small.remark =
        fmt::format("view of {} x {}; {}", window.view().width(), window.view().height(), detailText(window));
    window.stopServo();
    window.resize(Sized::View);
    PlainWindow bare(scene);
    plain.add([&] { return bare.orbit(options.time); });
  }
  // Once fixed, the budget no longer adapts: after all turns that it is to adapt in.
  window.view().detail().setBudget(kWholeScene * trianglesOf(scene));
  for (std::size_t turn = 0; turn < options.turns; ++turn) {
    window.startServo();
    full.add([&] { return window.orbit(options.time); });
    full.remark = detailText(window) + "; after the others";
    window.stopServo();
  }
  Figure drawing = latenessOf("lateness", "while the view is turned", with),
         still = latenessOf("lateness", "window asleep", without);
  setGoals(drawing, still);
  return {large.figure(kFrameGoal),
          small.figure(kFrameGoal),
          full.figure(0.0),
          plain.figure(0.0),
          drawing,
          still};
}

std::vector<Figure> measureBesideCheck(const WindowOptions& options) {
  return measureBeside<ChecksBeside>(options, "servo-beside-check", "while a scene is checked", "checked");
}

std::vector<Figure> measureBesideReport(const WindowOptions& options) {
  return measureBeside<ReportsBeside>(options, "servo-beside-report", "while reports are written",
                                      "reported");
}

std::vector<Figure> measureIdle(const WindowOptions& options) {
  BenchWindow window;
  window.open(pairOf(options.triangles));
  const int pictures = window.view().pictureCount();
  std::vector<double> percent;
  for (std::size_t turn = 0; turn < options.turns; ++turn) {
    const double start = milliseconds(), before = processorSeconds();
    BenchWindow::run(options.time);
    percent.push_back(1e5 * (processorSeconds() - before) / (milliseconds() - start));
  }
  Figure figure = figureOf("idle", "window at rest", "%", percent);
  figure.goal = kIdleGoal;
  figure.goalOf = "max";
  figure.remark = fmt::format("{} pictures", window.view().pictureCount() - pictures);
  return {figure};
}

std::vector<Figure> measureGlyphs(const WindowOptions& options) {
  BenchWindow window;
  window.open(pairOf(options.triangles));
  const auto snapshot = std::make_unique<ServoSnapshot>();
  const Scene& scene = window.application().session().scene();
  snapshot->moving = *scene.movingPart();
  snapshot->proxy = snapshot->handle = scene.find(snapshot->moving)->worldFromPart;
  std::vector<double> samples[2];
  double phase = 0.0;
  const auto frame = [&](std::size_t minima) {
    phase += 0.01;
    snapshot->wrench.force = {std::sin(phase), std::cos(phase), 1.0};
    snapshot->storedLmds = snapshot->lmdCount = static_cast<std::uint32_t>(minima);
    for (std::size_t i = 0; i < minima; ++i) {
      const double angle = phase + 0.06 * static_cast<double>(i);
      Lmd& lmd = snapshot->lmds[i].lmd;
      lmd.partPoint = {2.0 * std::cos(angle), 2.0 * std::sin(angle), 0.02 * static_cast<double>(i)};
      lmd.scenePoint = 1.2 * lmd.partPoint;
      lmd.distance = 0.01 * scene.haptics().springs.cutoff * static_cast<double>(i % 100);
    }
    return window.shown([&] { window.view().showSnapshot(*snapshot); });
  };
  std::vector<double> with, without, more;
  const double end =
      milliseconds() + static_cast<double>(options.turns) * static_cast<double>(options.time.count());
  for (std::size_t pair = 0; milliseconds() < end || pair < 2; ++pair) {
    // In turns first, so that neither gains by its place.
    const bool isWithFirst = pair % 2 == 0;
    const double first = frame(isWithFirst ? kMinima : 0), second = frame(isWithFirst ? 0 : kMinima);
    with.push_back(isWithFirst ? first : second);
    without.push_back(isWithFirst ? second : first);
    more.push_back(with.back() - without.back());
  }
  Figure cost = figureOf("glyphs", fmt::format("what {} minima add to a picture", kMinima), "ms", more);
  cost.goal = kGlyphGoal;
  cost.goalOf = "p50";
  cost.remark = "of pictures in pairs with them and without";
  return {cost, figureOf("glyphs", fmt::format("picture with {} minima", kMinima), "ms", with),
          figureOf("glyphs", "picture without minima", "ms", without)};
}

}  // namespace nearfit::bench
