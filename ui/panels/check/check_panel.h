#pragma once

#include <QWidget>
#include <memory>
#include <optional>
#include <vector>

#include "core/mesh/check/unrepaired.h"
#include "core/scene/part_geometry.h"
#include "core/session/session.h"
#include "ui/view3d/finding_marks.h"

class QLabel;
class QPushButton;
class QSortFilterProxyModel;
class QTableView;

namespace nearfit::ui {

class FindingsModel;
class HandState;
class PartChecks;
class RepairFields;
class SceneWork;
class Selection;
class Viewport;

/// Lists what is wrong with the mesh of the selected part, shows in the view where, and asks for repairs. While it is
/// hidden it shows nothing.
class CheckPanel : public QWidget {
  Q_OBJECT

 public:
  /// Sources of what it shows, and the view to mark places in; all outlive this.
  struct Context {
    Session& session;
    const Selection& selection;
    const HandState& hand;
    const SceneWork& work;
    PartChecks& checks;
    Viewport& view;
  };
  explicit CheckPanel(const Context& context, QWidget* parent = nullptr);

 public slots:
  /// Shows lengths in the unit that has been chosen.
  void refresh();
  /// Shows what repairs of the part did.
  void showRepair(const nearfit::GeometryRepair& repair);

 signals:
  /// Emitted when the user wants parts repaired, which share a geometry.
  void repairRequested(const std::vector<nearfit::PartId>& parts, const nearfit::MeshRepairs& repairs);

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  void setUpTable();
  void setUpLayout();
  const Part* subject() const;
  /// Follows selection, scene and checks.
  void follow();
  QString noteText() const;
  /// Says why nothing is offered for findings that cannot be repaired.
  void showUnrepaired(const std::vector<UnrepairedKind>& kinds);
  /// Shows the chosen finding in the view; `isNew` moves the camera there.
  void showPlace(bool isNew);
  void placeMarks();
  void showState();
  void repair();
  std::vector<PartId> partsToRepair() const;

  const Context context_;
  FindingMarks marks_;
  FindingsModel* model_;
  QSortFilterProxyModel* sorted_;
  QTableView* table_;
  QLabel *title_, *note_, *unrepaired_, *result_;
  RepairFields* fields_;
  QPushButton* repair_;
  PartGeometryPtr geometry_;                    ///< Geometry of the part shown.
  std::shared_ptr<const MeshCheck> check_;      ///< Its findings; null: not yet checked.
  std::weak_ptr<const PartGeometry> repaired_;  ///< Whose repair result_ describes.
  Subscription changes_;
};

}  // namespace nearfit::ui
