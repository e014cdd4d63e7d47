#pragma once

#include <array>
#include <optional>

#include "core/haptics/device_limits.h"
#include "core/haptics/virtual_coupling.h"
#include "ui/dialogs/feel_page.h"

class QCheckBox;
class QLabel;

namespace nearfit::ui {

/// What the bound of stability hangs on, and what of the wished coupling is in force.
struct CouplingBasis {
  DeviceLimits device;
  MassMetric metric;  ///< Of the moving part.
  /// Nominal, or while the servo runs as measured [s].
  double period = 1e-3;
  /// While the servo runs in the proxy mode.
  std::optional<CouplingState> inForce;
};

/// Margin, friction, and the coupling with the bound that it is held to.
class ProxyPage : public FeelPage {
  Q_OBJECT

 public:
  explicit ProxyPage(QWidget* parent = nullptr);

  void showBasis(const CouplingBasis& basis);

 protected:
  void refresh() override;

 private:
  /// One line of the coupling: stiffness and damping, each with what it is held to.
  struct Row {
    NumberField *stiffness, *damping;
    QLabel *stiffnessNote, *dampingNote;
    QString stiffnessUnit, dampingUnit;
  };
  struct Line {
    double stiffness, damping;          ///< In force.
    double mostStiffness, mostDamping;  ///< By the bound.
    double wishedStiffness, wishedDamping;
  };

  QWidget* makeCoupling();
  void makeRows();
  Row addRow(const Number& stiffness, const NumberOf& stiffnessOf, const Number& damping,
             const NumberOf& dampingOf);
  void showRow(const Row& row, const Line& line);

  QCheckBox* automatic_;
  std::array<Row, 2> rows_;  ///< Translation, rotation.
  QLabel* reason_;
  CouplingBasis basis_;
  CouplingSettings wishedThen_;  ///< When the basis was told: later wishes are not in force yet.
};

}  // namespace nearfit::ui
