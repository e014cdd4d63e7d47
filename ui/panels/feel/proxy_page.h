#pragma once

#include <array>

#include "ui/panels/feel/coupling_basis.h"
#include "ui/panels/feel/feel_page.h"

class QCheckBox;
class QLabel;

namespace nearfit::ui {

/// Margin, friction, and the coupling with the bound that limits it.
class ProxyPage : public FeelPage {
  Q_OBJECT

 public:
  explicit ProxyPage(QWidget* parent = nullptr);

  void showBasis(const CouplingBasis& basis);

 protected:
  void refresh() override;

 private:
  /// Widgets of one line of the coupling: stiffness and damping, each with a note on its limit.
  struct Row {
    NumberField *stiffness, *damping;
    QLabel *stiffnessNote, *dampingNote;
    QString stiffnessUnit, dampingUnit;
  };
  /// Values for such a line.
  struct Line {
    double stiffness, damping;          ///< In force.
    double mostStiffness, mostDamping;  ///< Limits by the bound.
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
  CouplingSettings wishedThen_;  ///< Wish when the basis was set; later wishes are not in force yet.
};

}  // namespace nearfit::ui
