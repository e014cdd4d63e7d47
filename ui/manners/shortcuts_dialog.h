#pragma once

#include <QDialog>

class QLineEdit;
class QMainWindow;
class QTreeWidget;

namespace nearfit::ui {

/// Every action of a window with the keys that trigger it, by menu, and what mouse and keys do in the view;
/// made anew from the actions each time that it is shown, so that it cannot lag behind them.
class ShortcutsDialog : public QDialog {
  Q_OBJECT

 public:
  /// @param window  Whose actions; outlives this.
  explicit ShortcutsDialog(QMainWindow* window);

  /// Shows it, filled anew, with the search ready to be typed into.
  void open() override;

 private:
  void fill();
  void fitToContent();
  void filter(const QString& words);

  QMainWindow* window_;
  QLineEdit* search_;
  QTreeWidget* list_;
};

}  // namespace nearfit::ui
