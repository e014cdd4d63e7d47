#pragma once

#include <QDialog>
#include <QString>
#include <functional>

class QLabel;
class QLineEdit;
class QPushButton;

namespace nearfit::ui {

/// Asks for a name and says at each keystroke whether it is accepted.
class PresetNameDialog : public QDialog {
  Q_OBJECT

 public:
  /// @param title   Title of the dialog.
  /// @param button  Text of the button that accepts the name.
  explicit PresetNameDialog(const QString& title, const QString& button, QWidget* parent = nullptr);

  struct Verdict {
    bool isRefused = false;
    QString note;  ///< Why, or what will happen; may be empty.
  };
  using Judge = std::function<Verdict(const QString& name)>;
  /// Shows the dialog. Returns the name without surrounding spaces; empty if the user cancels.
  QString ask(const QString& proposal, const Judge& judge);

 private:
  void look();

  QLineEdit* name_;
  QLabel* note_;
  QPushButton* accept_;
  Judge judge_;
};

}  // namespace nearfit::ui
