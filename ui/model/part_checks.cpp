#include "ui/model/part_checks.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/mesh/check/unrepaired.h"
#include "core/parallel/low_priority.h"
#include "core/scene/part_check.h"
#include "ui/model/hand_state.h"
#include "ui/model/scene_work.h"

namespace nearfit::ui {
namespace {

/// Time over which results are gathered [ms].
constexpr int kGather = 100;
/// Triangles that are checked in one go: some milliseconds.
constexpr std::size_t kTrianglesAtOnce = 20'000;

FindingsBadge badgeOf(const MeshCheck& check, FindingSeverity worst, const MeshRepairs& made) {
  FindingsBadge badge;
  badge.worst = worst;
  const std::vector<UnrepairedKind> unrepaired = unrepairedKinds(check, made);
  QStringList lines;
  for (std::size_t i = 0; i < kFindingKinds; ++i) {
    const auto kind = static_cast<FindingKind>(i);
    std::uint64_t places = check.total(kind).places;
    for (const MeshFinding& finding : check.findings)
      places -= finding.kind == kind && finding.isMended ? 1 : 0;
    if (places == 0) continue;
    lines << PartChecks::tr("%1: %L2").arg(nameOf(kind)).arg(places);
    const bool isLeft = std::ranges::any_of(
        unrepaired, [kind](const UnrepairedKind& left) { return left.kind == kind && left.areAll; });
    badge.canBeRepaired = badge.canBeRepaired || !isLeft;
  }
  badge.text = lines.join('\n');
  return badge;
}

}  // namespace

PartChecks::PartChecks(Session& session, const SceneWork& work, const HandState& hand, QObject* parent)
    : QObject(parent), session_(session), work_(work), hand_(hand) {
  late_.setSingleShot(true);
  late_.setInterval(kGather);
  connect(&late_, &QTimer::timeout, this, &PartChecks::changed);
  connect(&work, &SceneWork::busyChanged, this, &PartChecks::followWork);
  connect(&hand, &HandState::changed, this, &PartChecks::followWork);
  changes_ = session.onChange(SceneEvents::Stage::Application, [this] { followScene(); });
  followScene();
}

const PartChecks::Result* PartChecks::resultOf(const PartGeometryPtr& geometry) const {
  const auto found = results_.find(geometry.get());
  // Another geometry may have come to lie where one was.
  if (found == results_.end() || found->second.geometry.lock() != geometry) return nullptr;
  return &found->second;
}

std::shared_ptr<const MeshCheck> PartChecks::of(const PartGeometryPtr& geometry) const {
  const Result* result = resultOf(geometry);
  return result != nullptr ? result->check : nullptr;
}

bool PartChecks::hasFailed(const PartGeometryPtr& geometry) const {
  const Result* result = resultOf(geometry);
  return result != nullptr && result->check == nullptr;
}

void PartChecks::prefer(const PartGeometryPtr& geometry) {
  preferred_ = geometry;
  start();
}

std::map<PartId, FindingsBadge> PartChecks::badges() const {
  std::map<PartId, FindingsBadge> badges;
  std::map<const MeshCheck*, FindingsBadge> known;
  for (const Scene::PartPtr& part : session_.scene().parts()) {
    const std::shared_ptr<const MeshCheck> check = of(part->geometry);
    const std::optional<FindingSeverity> worst = check ? check->worst() : std::nullopt;
    if (!worst) continue;
    FindingsBadge& badge = known[check.get()];
    if (badge.text.isEmpty()) badge = badgeOf(*check, *worst, part->geometry->repairs);
    badges.emplace(part->id, badge);
  }
  return badges;
}

void PartChecks::followScene() {
  std::erase_if(results_, [](const auto& entry) { return entry.second.geometry.expired(); });
  late_.start();
  start();
}

void PartChecks::followWork() {
  // Loading and feeling want the processors.
  if (task_.isRunning() && (work_.isBusy() || hand_.status().isTaken())) task_.cancel();
  start();
}

std::vector<PartGeometryPtr> PartChecks::nextOnes() const {
  std::vector<PartGeometryPtr> next;
  std::set<const PartGeometry*> listed;
  std::size_t triangles = 0;
  const auto offer = [&](const PartGeometryPtr& geometry) {
    const bool isFull = !next.empty() && triangles + geometry->mesh.triangles().size() > kTrianglesAtOnce;
    if (isFull || resultOf(geometry) != nullptr || !listed.insert(geometry.get()).second) return;
    triangles += geometry->mesh.triangles().size();
    next.push_back(geometry);
  };
  if (const PartGeometryPtr preferred = preferred_.lock()) offer(preferred);
  for (const Scene::PartPtr& part : session_.scene().parts()) {
    if (triangles >= kTrianglesAtOnce) break;
    if (part->geometry) offer(part->geometry);
  }
  return next;
}

void PartChecks::start() {
  if (task_.isRunning() || work_.isBusy() || hand_.status().isTaken()) return;
  const std::vector<PartGeometryPtr> next = nextOnes();
  if (next.empty()) return;
  using Checks = std::vector<std::shared_ptr<const MeshCheck>>;
  const auto checks = std::make_shared<Checks>();
  const auto job = [next, checks](const ProgressCallback& progress) {
    lowerThreadPriority();
    for (const PartGeometryPtr& geometry : next) {
      std::shared_ptr<const MeshCheck> check;
      try {
        check = std::make_shared<const MeshCheck>(
            checkPart(*geometry, {}, [&progress](double) { return progress(0.0); }));
      } catch (const Cancelled&) {
        throw;
      } catch (...) {
        // The part has no badge, and the panel says why: nothing else depends on it.
      }
      checks->push_back(check);
    }
  };
  task_.run(job, [this, next, checks](const std::exception_ptr& error) {
    // A cancelled job may still add to its own list.
    if (!isCancelled(error)) {
      // One that did not come to its turn has failed too: it must not be tried for ever.
      for (std::size_t i = 0; i < next.size(); ++i)
        results_[next[i].get()] = {next[i], i < checks->size() ? (*checks)[i] : nullptr};
      if (!late_.isActive()) late_.start();
    }
    start();
  });
}

QString nameOf(FindingKind kind) {
  switch (kind) {
    case FindingKind::OpenEdges:
      return PartChecks::tr("Open edges");
    case FindingKind::HairlineCracks:
      return PartChecks::tr("Hairline cracks");
    case FindingKind::NonManifoldEdges:
      return PartChecks::tr("Non-manifold edges");
    case FindingKind::NonManifoldVertices:
      return PartChecks::tr("Non-manifold vertices");
    case FindingKind::SelfIntersections:
      return PartChecks::tr("Self-intersections");
    case FindingKind::InvertedShells:
      return PartChecks::tr("Inverted shells");
    case FindingKind::InconsistentEdges:
      return PartChecks::tr("Inconsistent edges");
    case FindingKind::DegenerateFaces:
      return PartChecks::tr("Faces without area");
    case FindingKind::DuplicateFaces:
      break;
  }
  return PartChecks::tr("Duplicate faces");
}

QString nameOf(FindingSeverity severity) {
  switch (severity) {
    case FindingSeverity::Note:
      return PartChecks::tr("no effect on contact");
    case FindingSeverity::Warning:
      return PartChecks::tr("contact is slower or two-sided");
    case FindingSeverity::Serious:
      break;
  }
  return PartChecks::tr("contact may be wrong");
}

QString countText(const MeshFinding& finding) {
  const bool isOne = finding.count == 1;
  const auto counted = [&](const QString& one, const QString& many) {
    return isOne ? one : many.arg(finding.count);
  };
  switch (finding.kind) {
    case FindingKind::OpenEdges:
    case FindingKind::HairlineCracks:
    case FindingKind::NonManifoldEdges:
    case FindingKind::InconsistentEdges:
      return counted(PartChecks::tr("1 edge"), PartChecks::tr("%L1 edges"));
    case FindingKind::NonManifoldVertices:
      return counted(PartChecks::tr("1 vertex"), PartChecks::tr("%L1 vertices"));
    case FindingKind::SelfIntersections:
      return counted(PartChecks::tr("1 pair of faces"), PartChecks::tr("%L1 pairs of faces"));
    case FindingKind::InvertedShells:
    case FindingKind::DegenerateFaces:
    case FindingKind::DuplicateFaces:
      break;
  }
  return counted(PartChecks::tr("1 face"), PartChecks::tr("%L1 faces"));
}

}  // namespace nearfit::ui
