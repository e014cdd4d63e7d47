#pragma once

#include <QWidget>
#include <optional>
#include <vector>

#include "core/mesh/check/mesh_check.h"
#include "core/mesh/check/mesh_repair.h"
#include "core/mesh/check/unrepaired.h"

class QCheckBox;
class QGridLayout;

namespace nearfit::ui {

class NumberField;

/// The choice of repairs, each with its parameter.
class RepairFields : public QWidget {
  Q_OBJECT

 public:
  explicit RepairFields(QWidget* parent = nullptr);

  /// Offers what mends these findings, with sizes that suit a part.
  /// @param unrepaired  Kinds for which nothing is offered.
  /// @param diagonal    Of the part [m].
  void suggest(const MeshCheck& check, const std::vector<UnrepairedKind>& unrepaired, double diagonal);
  bool isAnyChosen() const;
  /// Returns the chosen repairs, in the order in which they are made. What is being typed counts.
  MeshRepairs repairs();

 signals:
  /// Emitted when another choice is made.
  void changed();

 private:
  struct Row {
    QCheckBox* check = nullptr;
    NumberField* size = nullptr;  ///< Null for repairs without a size.
  };
  Row addRow(QGridLayout& grid, const char* name, const QString& text, const QString& help,
             const QString& sizeHelp);
  static void offer(const Row& row, bool isOn, double size);
  static std::optional<double> sizeOf(const Row& row);

  Row weld_, stitch_, clean_, drop_, orient_, fill_;
};

}  // namespace nearfit::ui
