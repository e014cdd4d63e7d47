#pragma once

#include <QDialog>
#include <cstddef>

class QLineEdit;
class QSpinBox;

namespace nearfit::ui {

class NumberField;

/// Asks what a report of the scene is to hold: threshold, and the path and certificate to report on.
class ReportDialog : public QDialog {
  Q_OBJECT

 public:
  /// @param threshold  Offered at first [m].
  ReportDialog(double threshold, QWidget* parent);

  /// Max distance of pairs that are found [m].
  double threshold() const;
  /// Number of findings to show in pictures; 0: each.
  std::size_t pictures() const;
  /// Files that the user chose; empty: none.
  QString pathFile() const;
  QString certificateFile() const;

 private:
  QWidget* makeFileField(QLineEdit& field, const QString& title, const QString& filter);

  NumberField* threshold_;
  QSpinBox* pictures_;
  QLineEdit *path_, *certificate_;
};

}  // namespace nearfit::ui
