#include <QStringList>
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "tests/bench/occ_program.h"
#include "tests/bench/window/bench_window.h"
#include "tests/bench/window/figures.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"
#include "ui/files/document.h"
#include "ui/view3d/view_detail.h"
#include "ui/widgets/error_box.h"

/// CAD documents, as a user drops them on the window.
namespace nearfit::bench {
namespace {

constexpr double kDocumentAnswerGoal = 100.0, kCachedFeelGoal = 300.0, kViseFeelGoal = 1500.0,
                 kBoxFeelGoal = 1000.0;  ///< [ms]

struct DroppedDocument {
  std::string name;
  std::filesystem::path file;
  double feelGoal = 0.0;  ///< From the drop until it can be felt [ms]; 0: none.
};

std::vector<DroppedDocument> documentsFor(const WindowOptions& options, const std::filesystem::path& folder) {
  std::vector<DroppedDocument> documents;
  if (!options.shared.empty()) {
    const std::filesystem::path models = options.shared / "models" / "public";
    documents.push_back({"vise", models / "steptools_vise.stp", kViseFeelGoal});
    documents.push_back({"box assembly", models / "trimesh_box_assembly.STEP", kBoxFeelGoal});
  }
  if (const std::filesystem::path program = occProgram(); !program.empty()) {
    const std::filesystem::path file = folder / "assembly.step";
    // Each shape once: that is the most to draw and to feel.
    makeAssembly(program, {options.instances, options.instances, options.million}, file);
    documents.push_back({"assembly", file});
  }
  return documents;
}

/// A drop of one document on an empty window.
class Drop {
 public:
  Drop(const DroppedDocument& document, bool isCached)
      : name_((isCached ? "cached " : "") + document.name),
        file_(document.file),
        feelGoal_(isCached ? kCachedFeelGoal : document.feelGoal) {
    ui::MainWindow& window = window_.application().window();
    // What was left out of a document is told too: it is loaded all the same.
    window.setFailureSink([this](const ui::Failure& failure) {
      told_ += (failure.summary + QStringLiteral(": ") + failure.details).toStdString();
    });
    QObject::connect(&window.document(), &ui::Document::loaded, &window_.application(),
                     [this](bool) { isLoaded_ = true; });
  }

  /// Two figures: an event's wait until all is drawn at rest, and the time until the document can be felt.
  std::vector<Figure> measure() {
    const double start = milliseconds();
    const Heartbeat heart;
    ui::Document& files = window_.application().window().document();
    files.dropFiles({QString::fromStdString(file_.string())});
    waitUntil("the document", [this] { return isLoaded_; });
    const double loaded = milliseconds() - start;
    if (triangles() == 0) throw Error(file_.string(), told_.empty() ? "nothing was loaded" : told_);
    bool isAnswered = false, isReady = false;
    files.prepareHierarchies([&](bool is) {
      isAnswered = true;
      isReady = is;
    });
    waitUntil("hierarchies", [&] { return isAnswered; });
    if (!isReady) throw Error(file_.string(), "its hierarchies cannot be had");
    const double ready = milliseconds() - start;
    window_.settle();
    return {waitOf(heart, loaded), feelOf(ready)};
  }

 private:
  std::size_t triangles() { return trianglesOf(window_.application().session().scene()); }

  Figure waitOf(const Heartbeat& heart, double loaded) {
    Figure figure = figureOf("documents", fmt::format("an event's wait; {}", name_), "ms", heart.waits);
    figure.goal = kDocumentAnswerGoal;
    figure.goalOf = "max";
    figure.remark = fmt::format("{} triangles loaded in {:.2f} s; {} in the last picture", triangles(),
                                loaded / 1e3, window_.view().detail().detail().isFull ? "all" : "not all");
    return figure;
  }

  Figure feelOf(double ready) {
    Figure figure = figureOf("documents", fmt::format("ready to feel; {}", name_), "ms", {ready});
    figure.goal = feelGoal_;
    if (feelGoal_ > 0.0) figure.goalOf = "max";
    return figure;
  }

  std::string name_;
  std::filesystem::path file_;
  double feelGoal_;
  std::string told_;
  bool isLoaded_ = false;
  BenchWindow window_;
};

}  // namespace

std::vector<Figure> measureDocuments(const WindowOptions& options) {
  const test::TemporaryFolder folder;
  std::vector<Figure> figures;
  for (const DroppedDocument& document : documentsFor(options, folder.path())) {
    const test::TemporaryFolder cache;
    const test::ScopedVariable variable("NEARFIT_CACHE", cache.path().string());
    // The first drop fills the cache for the second.
    for (const bool isCached : {false, true}) {
      for (Figure& figure : Drop(document, isCached).measure())
        figures.push_back(std::move(figure));
    }
  }
  return figures;
}

}  // namespace nearfit::bench
