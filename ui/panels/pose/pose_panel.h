#pragma once

#include <QWidget>
#include <array>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"

class QGridLayout;
class QLabel;
class QToolButton;

namespace nearfit {
struct Part;
}

namespace nearfit::ui {

class ElidedLabel;
class NumberField;

/// Shows and edits the pose of one part, or of one that leads others, in numbers: position in the user's unit, rotation as angles about the
/// fixed axes x, y, z; and its density. Numbers that the user leaves alone keep their exact values, except that an
/// angle turns the part about its pivot, which moves the origin of its file.
class PosePanel : public QWidget {
  Q_OBJECT

 public:
  explicit PosePanel(QWidget* parent = nullptr);

  /// @param name     Name of the part, for the heading; empty if none is chosen, and then
  ///                 nothing can be edited.
  /// @param refusal  Why the pose cannot be edited; empty if it can.
  /// @param help     Says more than the heading has room for.
  void showPart(const QString& name, const QString& refusal = {}, const QString& help = {});
  /// Shows the pose of a part. If it was moved by other means, true numbers replace text that
  /// could not be read.
  void showPose(const RigidTransform& worldFromPart);
  /// Shows a part that lags behind the hand: the numbers are the part's. A typed number becomes the hand's, a
  /// step moves the hand from where it is, and the rest of the hand's pose stays.
  void showPose(const RigidTransform& worldFromPart, const RigidTransform& worldFromHand);
  /// Shows the density of the parts and their total mass.
  /// @param isLocked  True if one of them, or a group around it, is locked.
  /// @param total     The mass to show [kg]; nullopt: the sum of theirs.
  void showMass(const std::vector<const Part*>& parts, bool isLocked = false,
                const std::optional<double>& total = {});
  /// Shows where the centre of mass is, in the world [m]; nullopt hides it.
  void showCentre(const std::optional<glm::dvec3>& inWorld);
  /// Shows what joints keep the part on; hidden if there are none.
  /// @param text       The first joint, in a line; empty: none.
  /// @param help       All of them.
  /// @param canRemove  The joints can be removed.
  void showJoints(const QString& text, const QString& help = {}, bool canRemove = false, int wholeStart = 0);
  /// Accepts a number that is still being typed, as leaving its field does.
  void commit();
  /// Sets what returns the pivot, in the part's frame [m]; the part's origin if not set.
  void setPivot(std::function<glm::dvec3()> pivotInPart) { pivotInPart_ = std::move(pivotInPart); }
  /// Returns how far an arrow key moves a part [m].
  double step() const;
  /// Returns how far an arrow key with Shift turns it [rad].
  double turnStep() const;

 signals:
  /// Emitted with the new pose of the part, or of the hand that holds it.
  void poseEdited(const nearfit::RigidTransform& worldFromPart);
  /// Emitted with the new density [kg/m^3].
  void densityEdited(double density);
  /// Emitted when the joints shown are to be removed.
  void jointRemovalRequested();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void setUpPose(QGridLayout& layout);
  void setUpMass(QGridLayout& layout);
  void setUpJoints(QGridLayout& layout);
  NumberField* makeLength(const QString& name, double limit, int decimals, double step);
  NumberField* makeAngle(const QString& name, double limit);
  /// @param widest  A text that the field must have room for.
  NumberField* prepared(NumberField* field, const QString& name, const QString& widest);
  void edit(int field);
  /// Turns the hand's pose about the pivot.
  void turnTo(const glm::dquat& rotation);
  void showDensity(const std::vector<const Part*>& parts);
  void refresh();

  ElidedLabel* heading_;
  std::array<NumberField*, 6> fields_{};
  NumberField *step_ = nullptr, *turnStep_ = nullptr, *density_ = nullptr;
  QLabel* mass_ = nullptr;
  ElidedLabel* centre_ = nullptr;
  QWidget* jointRow_ = nullptr;
  ElidedLabel* joints_ = nullptr;
  QToolButton* removeJoints_ = nullptr;
  std::function<glm::dvec3()> pivotInPart_;
  RigidTransform pose_, hand_;
  glm::dvec3 handAngles_{0.0};     ///< Angles of hand_ [rad].
  std::array<double, 6> shown_{};  ///< Numbers in the fields.
  bool isEditing_ = false;         ///< The part moves because a number is typed here.
};

}  // namespace nearfit::ui
