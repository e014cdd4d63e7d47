#include <cmath>
#include <ctime>
#include <thread>

#include <fmt/format.h>

#include "device/servo/servo_loop.h"
#include "tests/bench/bench_shapes.h"
#include "tests/bench/instances.h"
#include "tests/bench/statistics.h"
#include "tests/bench/window/bench_window.h"
#include "tests/bench/window/figures.h"
#include "tests/bench/window/plain_window.h"
#include "tests/support/part_geometries.h"
#include "ui/detail/view_detail.h"

/// Frames and what runs beside them.
namespace nearfit::bench {
namespace {

constexpr double kFrameGoal = 50.0;  ///< Twenty a second [ms].
constexpr double kLatenessFactor = 1.5;
constexpr double kGlyphGoal = 3.0, kIdleGoal = 1.0;
constexpr std::size_t kMinima = 100;

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

Figure latenessOf(std::string way, const std::vector<ServoStatistics>& turns) {
  const auto middle = [&](double fraction) {
    std::vector<double> values;
    for (const ServoStatistics& turn : turns)
      values.push_back(1e6 * turn.lateness.percentile(fraction));
    return SampleSummary(values).percentile(0.5);
  };
  Figure figure{"lateness", std::move(way), "us"};
  for (const ServoStatistics& turn : turns) {
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

/// Tells beside load too what a picture costs.
std::string busyText(double seconds, std::size_t pictures) {
  return fmt::format("{:.1f} ms of the processors each", 1e3 * seconds / static_cast<double>(pictures));
}

std::string detailText(BenchWindow& window) {
  return fmt::format("{} triangles a picture", window.view().detail().detail().triangles);
}

}  // namespace

std::vector<Figure> measureFrames(const WindowOptions& options) {
  BenchWindow window;
  const Scene scene = pairOf(options.triangles);
  window.open(scene);
  std::vector<double> frames, plainFrames;
  std::vector<ServoStatistics> with, without;
  std::string drawn;
  double busy = 0.0, plainBusy = 0.0;
  for (std::size_t turn = 0; turn < options.turns; ++turn) {
    window.startServo();
    const double busyBefore = processorSeconds();
    const std::vector<double> some = window.orbit(options.time);
    busy += processorSeconds() - busyBefore;
    drawn = detailText(window);
    window.stopServo();
    with.push_back(window.application().servo().statistics());
    frames.insert(frames.end(), some.begin(), some.end());
    window.startServo();
    // The window neither draws nor looks at the servo.
    std::this_thread::sleep_for(options.time);
    window.stopServo();
    without.push_back(window.application().servo().statistics());
    PlainWindow plain(scene);
    const double plainBefore = processorSeconds();
    const std::vector<double> others = plain.orbit(options.time);
    plainBusy += processorSeconds() - plainBefore;
    plainFrames.insert(plainFrames.end(), others.begin(), others.end());
  }
  Figure ours = figureOf("frame", "100k triangles; servo runs", "ms", frames);
  ours.goal = kFrameGoal;
  ours.goalOf = "p50";
  ours.remark = drawn + "; " + busyText(busy, frames.size());
  Figure plain = figureOf("frame", "plain VTK; no servo", "ms", plainFrames);
  plain.remark = busyText(plainBusy, plainFrames.size());
  Figure drawing = latenessOf("while the view is turned", with), still = latenessOf("window asleep", without);
  drawing.goal = kLatenessFactor * still.p99;
  drawing.goalOf = "p99";
  return {ours, plain, drawing, still};
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
  constexpr int kBlock = 5;
  const double end =
      milliseconds() + static_cast<double>(options.turns) * static_cast<double>(options.time.count());
  while (milliseconds() < end) {
    for (const std::size_t way : {0, 1}) {
      for (int i = 0; i < kBlock; ++i)
        samples[way].push_back(frame(way * kMinima));
    }
  }
  Figure none = figureOf("glyphs", "picture without minima", "ms", samples[0]);
  Figure with = figureOf("glyphs", "picture with 100 minima", "ms", samples[1]);
  with.goal = none.p50 + kGlyphGoal;
  with.goalOf = "p50";
  return {with, none};
}

}  // namespace nearfit::bench
