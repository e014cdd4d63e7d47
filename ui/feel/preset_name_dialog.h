#pragma once

#include <QDialog>
#include <QString>
#include <functional>

class QLabel;
class QLineEdit;
class QPushButton;

namespace nearfit::ui {

/// Asks for a name and says at each key whether it will do.
class PresetNameDialog : public QDialog {
  Q_OBJECT

 public:
  /// @param title, button  What is done with the name.
  explicit PresetNameDialog(const QString& title, const QString& button, QWidget* parent = nullptr);

  struct Verdict {
    bool isRefused = false;
    QString note;  ///< Why, or what happens then; may be empty.
  };
  using Judge = std::function<Verdict(const QString& name)>;
  /// The name; nothing when the user wants none.
  QString ask(const QString& proposal, const Judge& judge);

 private:
  void look();

  QLineEdit* name_;
  QLabel* note_;
  QPushButton* accept_;
  Judge judge_;
};

}  // namespace nearfit::ui
