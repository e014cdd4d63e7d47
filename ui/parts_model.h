#pragma once

#include <QAbstractTableModel>
#include <optional>

#include "core/scene/scene.h"

namespace nearfit::ui {

/// The scene's parts as a table: a row a part, icons for what can be switched. Shows a scene and asks for
/// changes by signals; changes nothing itself.
class PartsModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { Name, Moving, Visible, Locked, ColumnCount };

  explicit PartsModel(QObject* parent = nullptr);

  /// Keeps rows, and so the selection, where the parts are the same ones.
  void setScene(const Scene& scene);
  std::optional<PartId> partAt(const QModelIndex& index) const;
  /// Invalid when the part is not in the scene.
  QModelIndex indexOf(PartId part) const;

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role) override;

 signals:
  void renameRequested(nearfit::PartId part, const QString& name);

 private:
  QVariant decoration(const Part& part, int column) const;
  QString toolTip(const Part& part, int column) const;

  Scene scene_;
};

}  // namespace nearfit::ui
