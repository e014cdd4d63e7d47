#pragma once

#include <QWidget>
#include <array>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"

class QGridLayout;
class QLabel;

namespace nearfit {
struct Part;
}

namespace nearfit::ui {

class ElidedLabel;
class NumberField;

/// The pose of one part in numbers: position in the user's unit, rotation as angles about the fixed axes x,
/// y, z; and its density. Numbers that the user leaves alone stay exactly what they were.
class PosePanel : public QWidget {
  Q_OBJECT

 public:
  explicit PosePanel(QWidget* parent = nullptr);

  /// @param name     Of the part, for the heading; empty when no part is chosen, then nothing can be edited.
  /// @param refusal  Why the pose cannot be edited; empty when it can.
  /// @param help     Says more than the heading has room for.
  void showPart(const QString& name, const QString& refusal = {}, const QString& help = {});
  /// Of a part that stands somewhere. Where it has been moved by other means, what was typed and could not be
  /// read makes room for the true numbers.
  void showPose(const RigidTransform& worldFromPart);
  /// For a part that stays behind the hand: the numbers are the part's. One that is typed becomes the hand's,
  /// a step moves the hand on from where it is, and the rest of the hand's pose stays.
  void showPose(const RigidTransform& worldFromPart, const RigidTransform& worldFromHand);
  /// The density of the parts, and their mass together.
  /// @param isLocked  One of them, or a group that it is in.
  void showMass(const std::vector<const Part*>& parts, bool isLocked = false);
  /// Takes over a number that is still being typed, as leaving its field does.
  void commit();
  /// How far an arrow key moves a part [m].
  double step() const;
  /// How far one turns it, with Shift [rad].
  double turnStep() const;

 signals:
  /// Of the part, or of the hand that holds it.
  void poseEdited(const nearfit::RigidTransform& worldFromPart);
  /// [kg/m^3]
  void densityEdited(double density);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void setUpPose(QGridLayout& layout);
  void setUpMass(QGridLayout& layout);
  NumberField* makeLength(const QString& name, double limit, int decimals, double step);
  NumberField* makeAngle(const QString& name, double limit);
  NumberField* prepared(NumberField* field, const QString& name);
  void edit(int field);
  void showDensity(const std::vector<const Part*>& parts);
  void refresh();

  ElidedLabel* heading_;
  std::array<NumberField*, 6> fields_{};
  NumberField *step_ = nullptr, *turnStep_ = nullptr, *density_ = nullptr;
  QLabel* mass_ = nullptr;
  RigidTransform pose_, hand_;
  glm::dvec3 handAngles_{0.0};     ///< Of hand_ [rad].
  std::array<double, 6> shown_{};  ///< What stands in the fields.
  bool isEditing_ = false;         ///< What moves the part is a number typed here.
};

}  // namespace nearfit::ui
