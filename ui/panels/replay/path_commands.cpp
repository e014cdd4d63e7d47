#include "ui/panels/replay/path_commands.h"

#include <QAction>
#include <QFileInfo>
#include <QMenu>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/files/sha256.h"
#include "core/parallel/low_priority.h"
#include "core/path/certificate.h"
#include "core/path/path_animation.h"
#include "core/path/path_bodies.h"
#include "core/path/path_clearance.h"
#include "core/path/path_file.h"
#include "core/path/path_thinning.h"
#include "core/path/swept_volume.h"
#include "ui/panels/replay/path_dialogs.h"
#include "ui/panels/replay/replay.h"
#include "ui/panels/replay/timeline.h"
#include "ui/widgets/format.h"
#include "ui/widgets/length_unit.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/names.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/progress_dialog.h"
#include "ui/widgets/save_file.h"

namespace nearfit::ui {
namespace {

/// Progress when the hierarchies are there, and the proof begins.
constexpr double kPrepared = 0.3;
/// Range of plotted clearances as a share of the radius of what moves: farther away nothing is near.
constexpr double kClearanceRange = 1.0;

struct MadePath {
  AssemblyPath path;
  std::size_t before = 0;  ///< Number of poses of the motion.
};

AssemblyPath improved(const Scene& scene, AssemblyPath path, const PathWishes& wishes,
                      const ProgressCallback& progress) {
  if (!wishes.thin && !wishes.smooth) return path;
  constexpr double kThinned = 0.7;
  const PathCertifier certifier(scene, path, wishes.separation, stageCallback(progress, 0.0, kPrepared));
  if (wishes.thin)
    path = thinned(path, certifier, *wishes.thin, stageCallback(progress, kPrepared, kThinned)).path;
  if (wishes.smooth)
    path = smoothed(path, certifier, *wishes.smooth, stageCallback(progress, kThinned, 1.0)).path;
  return path;
}

/// Hash of a path file; empty unless it holds the path.
std::string hashIfItHolds(const AssemblyPath& path, const std::filesystem::path& file) {
  try {
    std::string sha256 = sha256OfFile(file);
    return isSamePath(readPathFile(file), path) ? sha256 : std::string();
  } catch (const FileError&) {
    // It was moved away or changed; the certificate holds the path itself.
    return {};
  }
}

QString partName(const Scene& scene, PartId id) {
  return shortName(scene.get(id).name);
}

/// In the unit that the dialog asks for it in, also where others are shorter: "0.000034 mm".
QString separationText(double metres) {
  const LengthUnit unit = shownLengthUnit();
  return formatNumber(metres / metresOf(unit)) + QChar(' ') + symbolOf(unit);
}

QString unprovenText(const Scene& scene, const UnprovenPlace& place, double separation, double startTime) {
  const QString part = partName(scene, place.part), other = partName(scene, place.other);
  if (place.isInside)
    return PathCommands::tr("Not certified: at the start “%1” meets “%2”, or one is inside the other.")
        .arg(part, other);
  return PathCommands::tr("Not certified: at %1 s “%2” and “%3” are %4 apart, which does not prove %5.")
      .arg(formatFixed(place.time - startTime, 3), part, other, formatLength(place.distance),
           separationText(separation));
}

}  // namespace

PathCommands::PathCommands(const Context& context, QWidget* window)
    : QObject(window), context_(context), window_(window), menu_(new QMenu(tr("P&ath"), window)) {
  menu_->setObjectName(QStringLiteral("pathMenu"));
  menu_->setToolTipsVisible(true);
  forMotion_ << add("pathStart", tr("Start at the time &shown"),
                    tr("Leave out what is before, in all commands on the path ([ in the timeline)"),
                    &PathCommands::startHere)
             << add("pathEnd", tr("&End at the time shown"),
                    tr("Leave out what is after, in all commands on the path (] in the timeline)"),
                    &PathCommands::endHere)
             << add("pathWhole", tr("Take all of the &motion"), tr("Leave nothing out"),
                    &PathCommands::takeWhole);
  menu_->addSeparator();
  forMotion_ << add(
      "savePath", tr("Save as &path…"),
      tr("Save the motion as a path: trimmed, thinned and smoothed only as far as it stays free"),
      &PathCommands::savePath);
  clearance_ = add("plotPathClearance", tr("Plot &clearance"),
                   tr("Find the clearance to other parts along the path, for the timeline and the plots"),
                   &PathCommands::plotClearance);
  menu_->addSeparator();
  forMotion_ << add("certifyPath", tr("Certif&y…"),
                    tr("Prove that the part keeps a separation from all others, everywhere on the path"),
                    &PathCommands::certify);
  certificate_ =
      add("saveCertificate", tr("Save ce&rtificate…"),
          tr("Save the proof as a file that nearfit-cli verify proves anew"), &PathCommands::saveCertificate);
  menu_->addSeparator();
  forMotion_ << add("exportPathCsv", tr("Export p&oses…"), tr("Write the poses as a table (CSV)"),
                    &PathCommands::exportCsv)
             << add("exportPathClearance", tr("Export clearances…"),
                    tr("Write the clearance to each part near the path as a table (CSV)"),
                    &PathCommands::exportClearance)
             << add("exportPathGltf", tr("Export &animation…"),
                    tr("Write the scene with the moving part as a glTF animation"),
                    &PathCommands::exportAnimation)
             << add("exportSwept", tr("Export swept &volume…"),
                    tr("Write the space that the part passes as a mesh (STL, OBJ, PLY)"),
                    &PathCommands::exportSwept);
  context_.timeline.setPathMenu(menu_);
  const auto follow = [this] {
    certified_ = nullptr;
    updateActions();
  };
  connect(&context_.replay, &Replay::opened, this, follow);
  connect(&context_.replay, &Replay::closed, this, follow);
  changes_ = context_.session.onChange(SceneEvents::Stage::Panels, [this] { followSession(); });
  updateActions();
}

PathCommands::~PathCommands() = default;

QAction* PathCommands::add(const char* name, const QString& text, const QString& help,
                           void (PathCommands::*command)()) {
  QAction* action = makeAction(this, name, text, {}, {}, help);
  connect(action, &QAction::triggered, this, command);
  menu_->addAction(action);
  return action;
}

void PathCommands::updateActions() {
  const bool canRun = context_.replay.isOpen() && !task_.isRunning();
  for (QAction* action : std::as_const(forMotion_))
    action->setEnabled(canRun);
  clearance_->setEnabled(canRun && context_.replay.path().has_value());
  certificate_->setEnabled(canRun && certified_ != nullptr && certified_->proof.isFree());
  menu_->menuAction()->setEnabled(context_.replay.isOpen());
}

void PathCommands::followSession() {
  if (certified_ == nullptr || context_.session.stateSerial() == certifiedState_) return;
  // It was proven of another scene.
  certified_ = nullptr;
  context_.timeline.showResult({});
  updateActions();
}

template <class Read>
auto PathCommands::orTell(const QString& attempt, const Read& read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (...) {
    emit failed(describe(attempt, std::current_exception()));
    return std::nullopt;
  }
}

std::optional<AssemblyPath> PathCommands::rangedPath() {
  const auto [from, to] = context_.timeline.range();
  return orTell(tr("The motion is no path."),
                [this, from = from, to = to] { return context_.replay.pathBetween(from, to); });
}

std::optional<QString> PathCommands::askForFile(const QString& title, const QString& filter,
                                                const QString& suffix) {
  return askForSave(
      {title, Preferences::lastFolder() + QStringLiteral("/path.") + suffix, {filter}, {suffix}}, window_);
}

void PathCommands::run(const QString& title, const QString& attempt, BackgroundTask::Job work,
                       std::function<void()> done) {
  if (task_.isRunning()) return;
  const auto job = [work = std::move(work)](const ProgressCallback& progress) {
    // The view goes first.
    lowerThreadPriority();
    work(progress);
  };
  const auto ended = [this, attempt, done = std::move(done)](const std::exception_ptr& error) {
    if (!error) {
      done();
    } else if (!isCancelled(error)) {
      emit failed(describe(attempt, error));
    }
    updateActions();
  };
  runWithDialog(task_, title, title + QChar(0x2026), window_, job, ended);
  updateActions();
}

void PathCommands::noteExported(const QString& file) {
  Preferences::rememberFolderOf(file);
  emit noted(tr("Exported %1").arg(QFileInfo(file).fileName()));
}

void PathCommands::startHere() {
  context_.timeline.setRange(context_.timeline.time(), context_.timeline.range().second);
}

void PathCommands::endHere() {
  context_.timeline.setRange(context_.timeline.range().first, context_.timeline.time());
}

void PathCommands::takeWhole() {
  context_.timeline.setRange(0.0, context_.timeline.duration());
}

void PathCommands::savePath() {
  const QString attempt = tr("The path could not be saved.");
  const std::optional<AssemblyPath> ranged = rangedPath();
  if (!ranged) return;
  const Scene scene = context_.session.scene();
  const auto separation = orTell(attempt, [&] { return defaultSeparation(scene, *ranged); });
  if (!separation) return;
  const auto wishes =
      askForPathWishes(context_.timeline.range(), context_.timeline.duration(), *separation, window_);
  if (!wishes) return;
  const auto path = orTell(attempt, [&] { return context_.replay.pathBetween(wishes->from, wishes->to); });
  if (!path) return;
  const auto file = askForFile(tr("Save path"), tr("Paths (*.nfpath)"), QStringLiteral("nfpath"));
  if (!file) return;
  const auto made = std::make_shared<MadePath>();
  made->path = *path;
  made->before = path->poses.size();
  const auto work = [made, scene, wishes = *wishes, to = toPath(*file)](const ProgressCallback& progress) {
    made->path = improved(scene, std::move(made->path), wishes, progress);
    writePathFile(made->path, to);
  };
  run(tr("Making a path"), attempt, work, [this, made, file = *file] {
    Preferences::rememberFolderOf(file);
    emit noted(tr("Saved %1: %L2 of %L3 poses")
                   .arg(QFileInfo(file).fileName())
                   .arg(made->path.poses.size())
                   .arg(made->before));
  });
}

void PathCommands::plotClearance() {
  if (!context_.replay.path()) return;
  const QString attempt = tr("The clearance could not be found.");
  const Scene scene = context_.session.scene();
  const AssemblyPath path = context_.replay.playedPath();
  const auto range = orTell(attempt, [&] { return kClearanceRange * pathBodies(scene, path).radius; });
  if (!range) return;
  const auto found = std::make_shared<std::vector<PathClearance>>();
  const auto work = [found, scene, path, range = *range](const ProgressCallback& progress) {
    *found = clearancesAlong(scene, path, range, progress);
  };
  run(tr("Finding clearances"), attempt, work, [this, found, scene, path, range = *range] {
    const std::optional<LeastPathClearance> least = leastOf(*found, path);
    context_.replay.showClearances(*found);
    emit noted(least ? tr("Min clearance %1 at %2 s, to %3")
                           .arg(formatLength(least->distance),
                                formatFixed(least->time - path.poses.front().time, 3),
                                partName(scene, least->other))
                     : tr("No other part is within %1 of the path").arg(formatRoundLength(range)));
  });
}

void PathCommands::certify() {
  const QString attempt = tr("The path could not be certified.");
  const std::optional<AssemblyPath> path = rangedPath();
  if (!path) return;
  const Scene scene = context_.session.scene();
  const auto offered = orTell(attempt, [&] { return defaultSeparation(scene, *path); });
  if (!offered) return;
  const auto separation = askForSeparation(*offered, window_);
  if (!separation) return;
  const auto certified = std::make_shared<Certified>();
  certified->scene = scene;
  certified->path = *path;
  const bool isSaved = !context_.session.file().empty() && !context_.session.isModified();
  if (isSaved) certified->sceneFile = context_.session.file();
  const auto work = [certified, separation = *separation,
                     pathFile = context_.replay.pathFile()](const ProgressCallback& progress) {
    if (!certified->sceneFile.empty()) certified->sceneSha256 = sha256OfFile(certified->sceneFile);
    if (!pathFile.empty()) certified->pathSha256 = hashIfItHolds(certified->path, pathFile);
    if (!certified->pathSha256.empty()) certified->pathFile = pathFile;
    const PathCertifier certifier(certified->scene, certified->path, separation,
                                  stageCallback(progress, 0.0, kPrepared));
    certified->proof = certifier.prove(certified->path, stageCallback(progress, kPrepared, 1.0));
  };
  const std::uint64_t state = context_.session.stateSerial();
  run(tr("Certifying"), attempt, work, [this, certified, state] {
    // It may have been closed, or the scene changed, meanwhile.
    if (!context_.replay.isOpen() || context_.session.stateSerial() != state) return;
    certified_ = certified;
    certifiedState_ = state;
    showCertified();
  });
}

void PathCommands::showCertified() {
  const PathProof& proof = certified_->proof;
  const double start = context_.replay.startTime();
  if (proof.isFree()) {
    const auto& poses = certified_->path.poses;
    context_.timeline.showResult(
        tr("Certified: from %1 s to %2 s the part keeps %3 from all other visible parts, everywhere on the "
           "path.")
            .arg(formatFixed(poses.front().time - start, 3), formatFixed(poses.back().time - start, 3),
                 separationText(proof.separation)));
    return;
  }
  const double time = proof.unproven->time - start;
  context_.replay.goTo(time);
  context_.timeline.showResult(unprovenText(certified_->scene, *proof.unproven, proof.separation, start),
                               time);
}

void PathCommands::saveCertificate() {
  if (certified_ == nullptr || !certified_->proof.isFree()) return;
  const auto file =
      askForFile(tr("Save certificate"), tr("Certificates (*.nfcert)"), QStringLiteral("nfcert"));
  if (!file || certified_ == nullptr) return;
  const auto work = [certified = certified_, to = toPath(*file)](const ProgressCallback&) {
    Certificate certificate =
        certificateOf(certified->scene, certified->path, certified->proof, certified->sceneSha256);
    certificate.pathFileSha256 = certified->pathSha256;
    if (!certified->sceneFile.empty()) certificate.sceneFile = certifiedName(certified->sceneFile, to);
    if (!certified->pathFile.empty()) certificate.pathFile = certifiedName(certified->pathFile, to);
    atomicWrite(to, certificateText(certificate));
  };
  run(tr("Writing"), tr("The certificate could not be saved."), work,
      [this, file = *file] { noteExported(file); });
}

void PathCommands::exportCsv() {
  const std::optional<AssemblyPath> path = rangedPath();
  if (!path) return;
  const auto file = askForFile(tr("Export poses"), tr("Tables (*.csv)"), QStringLiteral("csv"));
  if (!file) return;
  const auto work = [path = *path, to = toPath(*file)](const ProgressCallback&) {
    atomicWrite(to, pathCsv(path));
  };
  run(tr("Writing"), tr("The poses could not be exported."), work,
      [this, file = *file] { noteExported(file); });
}

void PathCommands::exportClearance() {
  const QString attempt = tr("The clearances could not be exported.");
  const std::optional<AssemblyPath> path = rangedPath();
  if (!path) return;
  const Scene scene = context_.session.scene();
  const auto range = orTell(attempt, [&] { return kClearanceRange * pathBodies(scene, *path).radius; });
  const auto file =
      range ? askForFile(tr("Export clearances"), tr("Tables (*.csv)"), QStringLiteral("csv")) : std::nullopt;
  if (!file) return;
  const auto work = [scene, path = *path, range = *range,
                     to = toPath(*file)](const ProgressCallback& progress) {
    atomicWrite(to, pathClearanceCsv(scene, path, clearancesAlong(scene, path, range, progress)));
  };
  run(tr("Finding clearances"), attempt, work, [this, file = *file] { noteExported(file); });
}

void PathCommands::exportAnimation() {
  const std::optional<AssemblyPath> path = rangedPath();
  if (!path) return;
  const auto file = askForFile(tr("Export animation"), tr("glTF files (*.glb)"), QStringLiteral("glb"));
  if (!file) return;
  const auto work = [scene = context_.session.scene(), path = *path,
                     to = toPath(*file)](const ProgressCallback&) { writePathGlb(scene, path, to); };
  run(tr("Writing"), tr("The animation could not be exported."), work,
      [this, file = *file] { noteExported(file); });
}

void PathCommands::exportSwept() {
  const QString attempt = tr("The swept volume could not be exported.");
  const std::optional<AssemblyPath> path = rangedPath();
  if (!path) return;
  const Scene scene = context_.session.scene();
  const auto offered = orTell(attempt, [&] { return defaultSweptResolution(scene, *path); });
  const auto resolution = offered ? askForResolution(*offered, window_) : std::nullopt;
  if (!resolution) return;
  const auto file = askForSave({tr("Export swept volume"),
                                Preferences::lastFolder() + QStringLiteral("/path.stl"),
                                {tr("STL files (*.stl)"), tr("OBJ files (*.obj)"), tr("PLY files (*.ply)")},
                                {QStringLiteral("stl"), QStringLiteral("obj"), QStringLiteral("ply")}},
                               window_);
  if (!file) return;
  const LengthUnit unit = shownLengthUnit();
  const auto work = [scene, path = *path, resolution = *resolution, metres = metresOf(unit),
                     to = toPath(*file)](const ProgressCallback& progress) {
    writeSweptVolume(scene, path, resolution, metres, to, progress);
  };
  run(tr("Making the swept volume"), attempt, work, [this, file = *file, unit] {
    Preferences::rememberFolderOf(file);
    emit noted(tr("Exported %1, in %2").arg(QFileInfo(file).fileName(), symbolOf(unit)));
  });
}

}  // namespace nearfit::ui
