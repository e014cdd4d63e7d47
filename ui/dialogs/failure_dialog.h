#pragma once

#include <QDialog>
#include <QVector>

#include "ui/dialogs/error_box.h"

class QLabel;
class QTableWidget;

namespace nearfit::ui {

/// Says what went wrong. It stops nothing: the window behind it goes on and can be used, above all to stop
/// the servo. What fails while it is open joins what it shows.
class FailureDialog : public QDialog {
  Q_OBJECT

 public:
  explicit FailureDialog(QWidget* parent);

  void add(const Failure& failure);

 private:
  /// What has failed in the same way several times stands there once.
  struct Entry {
    Failure failure;
    int count = 1;
  };
  void showAll();
  void showTable(const QVector<FailedItem>& rows, bool areFiles);
  QString text() const;

  QLabel *summary_, *details_;
  QTableWidget* table_;
  QVector<Entry> entries_;
};

}  // namespace nearfit::ui
