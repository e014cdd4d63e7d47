#pragma once

#include <QObject>
#include <QTimer>
#include <functional>
#include <memory>
#include <optional>

#include "app/desktop/device_source.h"
#include "app/desktop/device_worker.h"
#include "app/desktop/servo_report.h"
#include "app/desktop/servo_rows.h"
#include "core/haptics/rate_settings.h"
#include "core/path/assembly_path.h"
#include "core/session/session.h"
#include "device/servo/servo_loop.h"
#include "ui/model/servo_status.h"
#include "ui/widgets/error_box.h"

namespace nearfit::desktop {

/// Runs the servo for the session's moving part: makes the device, keeps the servo's scene and parameters as
/// the session has them, and puts the part's last pose into the session when it is put down. When the mode
/// changes, every hand goes on from where the part is. What may wait for a device (opening, arming, calibrating,
/// resetting, closing) runs on another thread.
class ServoController : public QObject {
  Q_OBJECT

 public:
  /// @param session  Must outlive this.
  /// @param devices  Must outlive this.
  ServoController(Session& session, DeviceSource& devices);
  ~ServoController() override;

  bool isRunning() const noexcept { return loopDevice_ != nullptr; }
  const ui::ServoStatus& status() const noexcept { return status_; }
  /// Returns the statistics of the current or the last run.
  ServoStatistics statistics() const { return loop_.statistics(); }
  /// Every tick, for plots and recordings. recordTo() begins a recording; it ends when the part is put down.
  ServoRows& rows() noexcept { return rows_; }

 public slots:
  /// Records what is felt to a file until the part is put down: from now on if it is in hand, else from the
  /// next time. Empty: ends the recording, or the wish for one.
  void recordTo(const QString& file);
  /// Takes the moving part in hand; no-op while it is. Waits for hierarchies that are not ready: see
  /// Document::prepareHierarchies(). Opens a device first; stop() ends that at once, whatever it waits for.
  /// @param device  Id of the device, if the hand is one.
  void start(nearfit::ui::Hand hand, const QString& device = {});
  /// Stops and puts the part down where it is, as one undo step.
  void stop();
  /// Turns the forces of the device in hand on or off.
  void setArmed(bool isArmed);
  /// Calibrates the device in hand: see HapticDevice::calibrate().
  void calibrate();
  /// Resets the device in hand: see HapticDevice::reset().
  void reset();
  /// Holds the part, and nothing is felt, while the hand repositions the device.
  void setClutched(bool isClutched);
  /// Sets how deflection becomes speed, for the device in hand and all later ones.
  void setRate(const nearfit::RateSettings& settings);
  /// Puts the pose in hand into the session and goes on.
  void commitPose();
  /// Gives the servo the session's scene once all its hierarchies are ready; until then the servo
  /// keeps the scene it has.
  void followSession();
  /// Guides the hand along a path of what is in hand, from now on; null: no longer. Paths of other parts are ignored.
  void setGuidance(const std::shared_ptr<const nearfit::AssemblyPath>& path);
  /// Sets the pose that the manual hand wants for the part; ignored for other hands.
  void moveHand(const nearfit::RigidTransform& worldFromPart);

 signals:
  /// Emitted when the status changed.
  void statusChanged(const nearfit::ui::ServoStatus& status);
  /// Emitted with the newest snapshot, up to 60 times a second.
  void snapshotArrived(const nearfit::ServoSnapshot& snapshot);
  /// Emitted when the manual or the scripted hand was brought back to the part, which is there.
  void handReturned(const nearfit::RigidTransform& worldFromPart);
  /// Emitted with a failure that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted when parts of the session's scene cannot be felt yet; call followSession() when they can.
  void hierarchiesNeeded();
  /// Emitted when a device was closed and others can have it.
  void deviceReleased(const QString& id);

 private:
  using DevicePtr = std::shared_ptr<HapticDevice>;

  /// Returns the session's scene for the servo, with the guidance if that is of what is in hand.
  std::unique_ptr<ServoScene> servoScene() const;
  /// The same to begin with: in the proxy mode, the part is a little off what it touches (startApart()).
  /// @param start  Where the part begins; std::nullopt: where the scene has it.
  std::unique_ptr<ServoScene> startScene(const std::optional<RigidTransform>& start = {}) const;
  /// Creates and starts the status' hand, which needs no opening.
  DevicePtr startedHand(const ServoScene& scene) const;
  void open(const QString& device);
  void takeOpened();
  void fail(const QString& summary, const std::exception_ptr& error);
  /// Runs the servo on a device that is open or needs no opening. Throws Error.
  void runOn(DevicePtr device, std::unique_ptr<const ServoScene> scene);
  void showRunning();
  /// Takes in the session's scene and settings while the servo runs.
  void takeScene();
  /// Starts the servo anew in the session's mode, with the hand where the part is.
  void restartAtPart();
  /// Closes the device on the other thread.
  void release();
  /// Runs `act` on the device, on the other thread.
  /// @param doing  Shown to the user meanwhile.
  /// @param what   Shown to the user if it fails.
  void command(const QString& doing, const QString& what, std::function<void(HapticDevice&)> act);
  /// Puts the device's own state into the status. Returns true if that is new.
  bool takeDeviceState();
  void poll();
  /// Tells of the newest snapshot, if that was not told yet.
  void showNewest();
  /// After the servo ended by itself: puts the part down, and tells the user if a device was lost.
  void putDownAfterEnd();
  void halt();

  Session& session_;
  DeviceSource& devices_;
  DevicePtr device_;                              ///< Device in hand, or being opened.
  DevicePtr loopDevice_;                          ///< Device that the servo runs on.
  std::shared_ptr<DeviceWorker::Ticket> ticket_;  ///< Job that is under way on the device.
  bool isOpened_ = false;  ///< The device is open and waits for the scene's hierarchies.
  RateSettings rate_;
  ServoRows rows_;
  ServoLoop loop_;
  QTimer timer_;
  ServoMeter meter_;
  PartId moving_{};
  std::optional<GroupId> movingGroup_;            ///< Set if `moving_` leads a group.
  std::uint64_t sceneSerial_ = 0;                 ///< Serial of the scene that owns `moving_`.
  HapticMode mode_{};                             ///< Mode that the servo runs in.
  std::shared_ptr<const AssemblyPath> guidance_;  ///< Null: none.
  RigidTransform startPose_;                      ///< Where the servo started with the part (worldFromPart).
  /// True while this puts the servo's own pose into the session: followSession() must not give that back to the
  /// servo as a new scene. No order of listeners makes it unnecessary.
  bool isCommitting_ = false;
  ui::ServoStatus status_;
  Subscription changes_;
  DeviceWorker worker_;  ///< Destroyed first: its jobs call back into this.
};

}  // namespace nearfit::desktop
