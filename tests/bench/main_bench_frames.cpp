#include <QApplication>
#include <QElapsedTimer>
#include <exception>
#include <iostream>
#include <memory>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/session/session.h"
#include "tests/bench/bench_shapes.h"
#include "tests/bench/command_program.h"
#include "tests/bench/digest.h"
#include "tests/bench/instances.h"
#include "tests/bench/skip_row.h"
#include "tests/support/part_geometries.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/view3d/view_detail.h"
#include "ui/view3d/viewport.h"

/// Times the frames of a view in which nothing changes, and the same drawn all the same; writes the row for
/// "nearfit-bench skips" to the standard output.
namespace {

using namespace nearfit;

constexpr std::size_t kParts = 8, kFrames = 40, kBlock = 20;
constexpr int kWidth = 1000, kHeight = 700;
constexpr std::uint32_t kTeeth = 25;

/// A view of some gears, with what a servo tells of the first.
class View {
 public:
  View()
      : selection_(session_),
        poses_(session_),
        viewport_(std::make_shared<ui::PartShapeCache>(), selection_, poses_) {
    const PartGeometryPtr gear = test::freshGeometryOf(bench::gearMesh(kTeeth));
    const Scene scene = bench::gridOf({&gear, 1}, kParts);
    snapshot_->moving = *scene.movingPart();
    snapshot_->proxy = snapshot_->handle = scene.find(snapshot_->moving)->worldFromPart;
    snapshot_->wrench.force = {1.0, 2.0, 3.0};
    snapshot_->storedLmds = snapshot_->lmdCount = 1;
    snapshot_->lmds[0].lmd.partPoint = {2.0, 0.0, 0.0};
    snapshot_->lmds[0].lmd.scenePoint = {6.0, 0.0, 0.0};
    viewport_.resize(kWidth, kHeight);
    viewport_.setScene(scene);
    viewport_.show();
    settle();
    viewport_.showSnapshot(*snapshot_);
    settle();
    if (viewport_.pictureCount() == 0) throw Error("view", "it draws nothing", "give it a display");
  }

  /// What the application does each time that it looks at the servo. @param isForced  Draw in any case.
  void frame(bool isForced) {
    viewport_.showSnapshot(*snapshot_);
    if (isForced) viewport_.renderWindow()->Render();
    QApplication::processEvents();
    viewport_.renderWindow()->WaitForCompletion();
  }

  /// Once it is at rest: until then a picture drawn all the same is not smooth.
  std::uint64_t picture() {
    constexpr int kMilliseconds = 10;
    while (!viewport_.detail().isSettled())
      QApplication::processEvents(QEventLoop::AllEvents, kMilliseconds);
    const QImage image = viewport_.grabFramebuffer().convertToFormat(QImage::Format_RGB32);
    bench::Digest digest;
    for (int y = 0; y < image.height(); ++y) {
      const auto* line = reinterpret_cast<const QRgb*>(image.constScanLine(y));
      for (int x = 0; x < image.width(); ++x)
        digest.add(std::uint64_t{line[x]});
    }
    return digest.value();
  }
  int pictureCount() const { return viewport_.pictureCount(); }

 private:
  /// Until the window system has nothing more to say.
  static void settle() {
    constexpr int kMilliseconds = 500;
    QElapsedTimer timer;
    timer.start();
    while (timer.elapsed() < kMilliseconds)
      QApplication::processEvents(QEventLoop::AllEvents, kMilliseconds);
  }

  Session session_;
  ui::Selection selection_;
  ui::ShownPoses poses_;
  ui::Viewport viewport_;
  std::unique_ptr<ServoSnapshot> snapshot_ = std::make_unique<ServoSnapshot>();
};

bench::SkipRow measure() {
  View view;
  bench::SkipRow row{"frames", fmt::format("{} gears at rest", kParts), "frame", {}, {}, {}};
  bench::RunOptions turns;
  turns.block = kBlock;
  int drawn = 0, pictures = 0;
  const auto answer = [&] { return view.picture(); };
  bench::takeTurns(row, kFrames,
                   {[&](std::size_t) {
                      const int before = view.pictureCount();
                      view.frame(false);
                      drawn += view.pictureCount() - before;
                      ++pictures;
                    },
                    answer},
                   {[&](std::size_t) { view.frame(true); }, answer}, turns);
  row.remark = fmt::format("{} of {} pictures of {} x {}", pictures - drawn, pictures, kWidth, kHeight);
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  int code = 0;
  try {
    ui::Viewport::setDefaultSurfaceFormat();
    const QApplication qt(argc, argv);
    const bench::SkipRow row = measure();
    bench::writeSkipRows(std::cout, {&row, 1});
  } catch (const std::exception& e) {
    fmt::print(stderr, "nearfit-bench-frames: {}\n", e.what());
    code = 1;
  }
  bench::endProgram(code);
}
