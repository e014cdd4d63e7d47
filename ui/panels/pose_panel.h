#pragma once

#include <QWidget>
#include <array>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"

class QDoubleSpinBox;
class QLabel;

namespace nearfit::ui {

/// The pose of one part in numbers: position in millimetres, rotation as angles about the fixed axes x, y, z
/// in degrees. Numbers that the user leaves alone stay exactly what they were.
class PosePanel : public QWidget {
  Q_OBJECT

 public:
  explicit PosePanel(QWidget* parent = nullptr);

  /// @param name  Of the part, for the heading; empty when no part is chosen, then nothing can be edited.
  void showPart(const QString& name, bool isEditable);
  void showPose(const RigidTransform& worldFromPart);
  /// Takes over a number that is still being typed, as leaving its field does.
  void commit();
  /// How far an arrow key moves a part [m].
  double step() const;

 signals:
  void poseEdited(const nearfit::RigidTransform& worldFromPart);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  QDoubleSpinBox* makeField(const QString& name, double limit, int decimals, const QString& suffix,
                            double step);
  void edit(int field);
  void refresh();

  QLabel* heading_;
  std::array<QDoubleSpinBox*, 6> fields_{};
  QDoubleSpinBox* step_ = nullptr;
  RigidTransform pose_;
  glm::dvec3 angles_{0.0};  ///< Of pose_ [rad].
};

}  // namespace nearfit::ui
