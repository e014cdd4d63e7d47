#pragma once

#include <QDialog>

class QLineEdit;
class QMainWindow;
class QTreeWidget;

namespace nearfit::ui {

/// Lists every action of a window with its keys, by menu, and what mouse and keys do in the view. Rebuilt
/// from the actions each time that it is shown, so that it cannot lag behind them.
class ShortcutsDialog : public QDialog {
  Q_OBJECT

 public:
  /// @param window  Window whose actions are listed; must outlive this.
  explicit ShortcutsDialog(QMainWindow* window);

  /// Rebuilds the list and shows it, with the focus in the search.
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
