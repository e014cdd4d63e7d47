#pragma once

#include <QDialog>
#include <QVector>

#include "ui/widgets/error_box.h"

class QLabel;
class QTableWidget;

namespace nearfit::ui {

/// Says what went wrong. It blocks nothing: the window behind it stays usable, above all to stop the servo.
/// Failures that follow while it is open are added to it.
class FailureDialog : public QDialog {
  Q_OBJECT

 public:
  explicit FailureDialog(QWidget* parent);

  void add(const Failure& failure);

 private:
  /// A failure that occurred several times is listed once.
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
