#pragma once

#include <array>

#include <glm/vec3.hpp>

#include "ui/panels/feel/coupling_basis.h"
#include "ui/panels/feel/feel_page.h"

class QCheckBox;
class QLabel;

namespace nearfit::ui {

class LocksPage;

/// Stiffness, damping and number of the springs, with what is enforced on their sum.
class SpringPage : public FeelPage {
  Q_OBJECT

 public:
  explicit SpringPage(QWidget* parent = nullptr);

  void showBasis(const CouplingBasis& basis);

 protected:
  void refresh() override;

 private:
  void showBound();

  NumberField *linear_, *printed_;  ///< One for each law, with its unit and limits.
  QLabel *linearLabel_, *printedLabel_;
  QLabel *limits_, *bound_;
  CouplingBasis basis_;
};

/// Weight and inertia, both optional.
class WeightPage : public FeelPage {
  Q_OBJECT

 public:
  explicit WeightPage(QWidget* parent = nullptr);
  /// @param name  Name of the moving part; empty if there is none.
  /// @param mass  [kg]
  void showMass(const QString& name, double mass);

 protected:
  void refresh() override;

 private:
  QCheckBox* inertia_;
  QLabel* mass_;
};

/// How the motion of a device maps to the motion of the hand in the scene.
class WorkspacePage : public FeelPage {
  Q_OBJECT

 public:
  explicit WorkspacePage(QWidget* parent = nullptr);

 protected:
  void refresh() override;

 private:
  void makeAngles();
  void turn(int axis, double degrees);

  LocksPage* locks_;
  std::array<NumberField*, 3> angleFields_{};
  glm::dvec3 angles_{0.0};  ///< Angles of the orientation offset [rad].
};

}  // namespace nearfit::ui
