#include "core/session/scene_events.h"

namespace nearfit {

void Subscription::end() noexcept {
  if (listener_ == nullptr) return;
  // SceneEvents holds it too while it calls it.
  listener_->hasEnded = true;
  listener_.reset();
}

Subscription SceneEvents::subscribe(Stage stage, std::function<void()> listener) {
  Listeners& listeners = stages_.at(static_cast<std::size_t>(stage));
  std::erase_if(listeners, [](const auto& each) { return each.expired(); });
  auto added = std::make_shared<Subscription::Listener>(Subscription::Listener{std::move(listener)});
  listeners.push_back(added);
  return Subscription(std::move(added));
}

bool SceneEvents::tell(const Listeners& listeners, std::uint64_t round) const {
  for (const auto& each : listeners) {
    const std::shared_ptr<Subscription::Listener> listener = each.lock();
    if (listener == nullptr || listener->hasEnded) continue;
    listener->call();
    if (completed_ > round) return false;
  }
  return true;
}

void SceneEvents::notify() {
  const std::uint64_t round = ++rounds_;
  // A copy, since a listener may subscribe another.
  const std::array<Listeners, 4> stages = stages_;
  for (const Listeners& listeners : stages)
    if (!tell(listeners, round)) return;
  completed_ = round;
}

}  // namespace nearfit
