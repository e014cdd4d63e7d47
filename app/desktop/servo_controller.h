#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <memory>
#include <optional>

#include "core/session.h"
#include "device/servo_loop.h"
#include "ui/dialogs/error_box.h"
#include "ui/servo_status.h"

namespace nearfit::desktop {

/// Runs the servo for the session's moving part: makes the device, keeps the servo's scene and parameters as
/// the session has them, and puts the part's last pose into the session when it is put down.
class ServoController : public QObject {
  Q_OBJECT

 public:
  /// @param session  Outlives this.
  explicit ServoController(Session& session);
  ~ServoController() override;

  bool isRunning() const noexcept { return device_ != nullptr; }

 public slots:
  /// Takes the moving part in hand; does nothing while it is. Waits for hierarchies that are not ready: see
  /// Document::prepareHierarchies.
  void start(nearfit::ui::Hand hand);
  /// Stops and puts the part down where it is, as one step of undo.
  void stop();
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

 private:
  /// Makes the device of a hand and lets the servo run on it. Throws Error.
  void take(ui::Hand hand);
  void poll();
  void measure();
  void halt();

  Session& session_;
  std::unique_ptr<HapticDevice> device_;
  ServoLoop loop_;
  QTimer timer_;
  QElapsedTimer sinceMeasured_;
  std::uint64_t ticksMeasured_ = 0;  ///< The tick since which the rate is measured; 0 before the first.
  double timeMeasured_ = 0.0;        ///< Of that tick, by the servo's clock [s].
  PartId moving_{};
  HapticMode mode_{};  ///< That the hand was made for.
  bool isCommitting_ = false;
  ui::ServoStatus status_;
};

}  // namespace nearfit::desktop
