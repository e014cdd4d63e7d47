#pragma once

#include <QObject>
#include <QTimer>
#include <functional>
#include <memory>

#include "app/desktop/device_source.h"
#include "app/desktop/device_worker.h"
#include "app/desktop/servo_meter.h"
#include "app/desktop/servo_rows.h"
#include "core/haptics/rate_settings.h"
#include "core/session.h"
#include "device/servo/servo_loop.h"
#include "ui/dialogs/error_box.h"
#include "ui/servo_status.h"

namespace nearfit::desktop {

/// Runs the servo for the session's moving part: makes the device, keeps the servo's scene and parameters as
/// the session has them, and puts the part's last pose into the session when it is put down. What may have to
/// wait for a device (opening, arming, calibrating, resetting, closing) is done in another thread.
class ServoController : public QObject {
  Q_OBJECT

 public:
  /// @param session, devices  Outlive this.
  ServoController(Session& session, DeviceSource& devices);
  ~ServoController() override;

  bool isRunning() const noexcept { return loopDevice_ != nullptr; }
  const ui::ServoStatus& status() const noexcept { return status_; }
  /// Of what runs, or ran last.
  ServoStatistics statistics() const { return loop_.statistics(); }
  /// Each tick, for plots, and recordings of them: begun by recordTo, ended when the part is put down.
  ServoRows& rows() noexcept { return rows_; }

 public slots:
  /// What is felt next, or from now on where the part is in hand, is recorded to that file until it is put
  /// down; empty ends a recording, or what would be one.
  void recordTo(const QString& file);
  /// Takes the moving part in hand; does nothing while it is. Waits for hierarchies that are not ready: see
  /// Document::prepareHierarchies. A device is opened first: `stop` ends that at once, whatever it waits for.
  /// @param device  Of the hand of a device: which.
  void start(nearfit::ui::Hand hand, const QString& device = {});
  /// Stops and puts the part down where it is, as one step of undo.
  void stop();
  /// Lets the forces of a device in hand out, or no more.
  void setArmed(bool isArmed);
  /// Its handle is held as HapticDevice::calibrate says.
  void calibrate();
  /// HapticDevice::reset.
  void reset();
  /// The part stays, and nothing is felt, while the device in hand is brought elsewhere.
  void setClutched(bool isClutched);
  /// Of devices that are driven by pushing: of this one and all later ones.
  void setRate(const nearfit::RateSettings& settings);
  /// Puts the pose in hand into the session and goes on.
  void commitPose();
  /// Gives the servo the scene as the session has it, once all its hierarchies are ready; until then the
  /// servo keeps what it has.
  void followSession();
  /// Where the manual hand wants the part; ignored for other hands.
  void moveHand(const nearfit::RigidTransform& worldFromPart);

 signals:
  void statusChanged(const nearfit::ui::ServoStatus& status);
  void snapshotArrived(const nearfit::ServoSnapshot& snapshot);
  void failed(const nearfit::ui::Failure& failure);
  /// The session's scene has parts that cannot be felt yet; followSession wants to be called when they can.
  void hierarchiesNeeded();
  /// It is closed, and others can have it.
  void deviceReleased(const QString& id);

 private:
  using DevicePtr = std::shared_ptr<HapticDevice>;

  /// Of the status' hand, which needs no opening.
  DevicePtr startedHand(const ServoScene& scene) const;
  void open(const QString& device);
  void takeOpened();
  void fail(const QString& summary, const std::exception_ptr& error);
  /// Lets the servo run on a device that is open, or one that need not be opened. Throws Error.
  void runOn(DevicePtr device, std::unique_ptr<const ServoScene> scene);
  void showRunning();
  /// Closes a device of the user's in the other thread.
  void release();
  /// @param doing  For the user meanwhile.
  /// @param what   When it fails.
  void command(const QString& doing, const QString& what, std::function<void(HapticDevice&)> act);
  /// Puts what the device says of itself into the status; true when that is new.
  bool takeDeviceState();
  void poll();
  /// The servo has ended by itself: the part is put down, and the user told when a device was lost.
  void putDownAfterEnd();
  void halt();

  Session& session_;
  DeviceSource& devices_;
  DevicePtr device_;                              ///< In hand, or being opened for it.
  DevicePtr loopDevice_;                          ///< That the servo runs on.
  std::shared_ptr<DeviceWorker::Ticket> ticket_;  ///< Of what is being done with the device.
  bool isOpened_ = false;                         ///< The device waits for the scene to be ready.
  RateSettings rate_;
  ServoRows rows_;
  ServoLoop loop_;
  QTimer timer_;
  ServoMeter meter_;
  PartId moving_{};
  std::uint64_t sceneSerial_ = 0;  ///< Of the session's scene that it is of.
  HapticMode mode_{};              ///< That the hand was made for.
  bool isCommitting_ = false;
  ui::ServoStatus status_;
  DeviceWorker worker_;  ///< Ends first: its jobs tell of themselves here.
};

}  // namespace nearfit::desktop
