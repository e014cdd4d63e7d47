#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace nearfit {

/// Keeps a listener of SceneEvents subscribed until it is destroyed, assigned to or ended. May outlive the
/// SceneEvents.
class [[nodiscard]] Subscription {
 public:
  Subscription() = default;
  Subscription(Subscription&&) noexcept = default;
  Subscription& operator=(Subscription&& other) noexcept {
    end();
    listener_ = std::move(other.listener_);
    return *this;
  }
  Subscription(const Subscription&) = delete;
  Subscription& operator=(const Subscription&) = delete;
  ~Subscription() { end(); }

  /// From now on the listener is not called, even if a notification is under way.
  void end() noexcept;

 private:
  friend class SceneEvents;
  struct Listener {
    std::function<void()> call;
    bool hasEnded = false;
  };
  explicit Subscription(std::shared_ptr<Listener> listener) noexcept : listener_(std::move(listener)) {}

  std::shared_ptr<Listener> listener_;
};

/// Tells listeners of each change, stage by stage: a listener finds what earlier stages keep up to date with the
/// newest state. Single-threaded.
class SceneEvents {
 public:
  /// In the order in which they are told.
  enum class Stage : std::uint8_t {
    Model,        ///< What follows from the scene, as the selection does.
    View,         ///< What draws the scene.
    Panels,       ///< Panels, tools, and what looks after files.
    Application,  ///< What hands the scene on, to a device and its servo.
  };

  SceneEvents() = default;
  SceneEvents(const SceneEvents&) = delete;
  SceneEvents& operator=(const SceneEvents&) = delete;

  /// Adds a listener after all others of its stage. One added during a notification hears of the next change.
  Subscription subscribe(Stage stage, std::function<void()> listener);

  /// Calls all listeners. They may subscribe, end subscriptions and notify again: that notification tells all,
  /// from the first stage on, and the one around it ends there, as it has nothing newer to tell. If a listener
  /// throws, those after it are not called.
  void notify();

 private:
  using Listeners = std::vector<std::weak_ptr<Subscription::Listener>>;
  /// Calls those of one stage. False if a newer notification has told all meanwhile.
  bool tell(const Listeners& listeners, std::uint64_t round) const;

  std::array<Listeners, 4> stages_;
  std::uint64_t rounds_ = 0;     ///< Notifications begun.
  std::uint64_t completed_ = 0;  ///< The newest one that told all.
};

}  // namespace nearfit
