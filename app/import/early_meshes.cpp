#include "app/import/early_meshes.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include <Message_ProgressRange.hxx>
#include <TopAbs_ShapeEnum.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Shape.hxx>

#include "app/import/solid_bodies.h"

namespace nearfit::importer {
namespace {

/// The shell of a solid that has one; a null shape for others.
TopoDS_Shape onlyShellOf(const TopoDS_Shape& solid) {
  TopoDS_Shape shell;
  for (TopoDS_Iterator child(solid); child.More(); child.Next()) {
    if (child.Value().ShapeType() != TopAbs_SHELL) continue;
    if (!shell.IsNull()) return {};
    shell = child.Value();
  }
  return shell;
}

bool hasFewFaces(const TopoDS_Shape& shell) {
  std::size_t count = 0;
  for (TopExp_Explorer face(shell, TopAbs_FACE); face.More(); face.Next())
    if (++count > EarlyMeshes::kMaxFaces) return false;
  return count > 0;
}

}  // namespace

struct EarlyMeshes::Job {
  TopoDS_Shape shell;
  std::optional<Mesh> mesh;
};

EarlyMeshes::EarlyMeshes(const MeshRequest& like, std::size_t threads)
    : like_(std::make_unique<const MeshRequest>(like)) {
  const std::size_t count = std::min(threads, kMaxThreads);
  threads_.reserve(count);
  try {
    while (threads_.size() < count)
      threads_.emplace_back([this] { work(); });
  } catch (const std::system_error&) {
    // It works with the threads that were started.
  } catch (...) {
    // They wait for work, and would be waited for.
    end();
    throw;
  }
}

EarlyMeshes::~EarlyMeshes() {
  end();
}

void EarlyMeshes::add(const TopoDS_Shape& solid) {
  if (threads_.empty() || solid.IsNull() || solid.ShapeType() != TopAbs_SOLID) return;
  // Without its place, like the product that take() is asked for.
  TopoDS_Shape shell = onlyShellOf(solid.Located(TopLoc_Location()));
  // A solid that shares something is left out, also if it has several shells: those after it may share with it alone.
  if (!isNew(solid) || shell.IsNull() || !hasFewFaces(shell)) return;
  auto job = std::make_unique<Job>(Job{std::move(shell), std::nullopt});
  std::swap(job, last_);
  if (job == nullptr) return;
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
  }
  changed_.notify_one();
}

bool EarlyMeshes::isNew(const TopoDS_Shape& solid) {
  bool isNew = true;
  std::vector<const void*> own;
  for (const TopAbs_ShapeEnum kind : {TopAbs_FACE, TopAbs_EDGE}) {
    for (TopExp_Explorer each(solid, kind); each.More(); each.Next()) {
      own.push_back(each.Current().TShape().get());
      isNew = isNew && !known_.contains(own.back());
    }
  }
  known_.insert(own.begin(), own.end());
  return isNew;
}

std::size_t EarlyMeshes::meshedCount() const {
  const std::lock_guard lock(mutex_);
  return done_;
}

void EarlyMeshes::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return isEnding_ || begun_ < jobs_.size(); });
    if (isEnding_) return;
    Job& job = *jobs_[begun_++];
    lock.unlock();
    meshOne(job);
    lock.lock();
    ++done_;
  }
}

void EarlyMeshes::meshOne(Job& job) const {
  try {
    Mesh mesh;
    MeshRequest request = *like_;
    request.body.shells = {job.shell};
    request.colours = nullptr;
    request.faces = &mesh.faces;
    request.usesAllThreads = false;
    mesh.shape = meshBody(request, Message_ProgressRange());
    if (!mesh.shape.triangles.empty()) job.mesh = std::move(mesh);
  } catch (...) {
    // It is meshed again with those that are left, and what fails then is told.
  }
}

void EarlyMeshes::end() {
  {
    const std::lock_guard lock(mutex_);
    isEnding_ = true;
  }
  changed_.notify_all();
  // Their destructors wait for them.
  threads_.clear();
}

void EarlyMeshes::finish() {
  end();
  last_.reset();
  for (const std::unique_ptr<Job>& job : jobs_)
    byShell_.try_emplace(job->shell.TShape().get(), job.get());
}

std::optional<EarlyMeshes::Mesh> EarlyMeshes::take(const Body& body) {
  if (body.shells.size() != 1) return std::nullopt;
  const auto at = byShell_.find(body.shells.front().TShape().get());
  if (at == byShell_.end() || !at->second->shell.IsEqual(body.shells.front())) return std::nullopt;
  return std::exchange(at->second->mesh, std::nullopt);
}

}  // namespace nearfit::importer
