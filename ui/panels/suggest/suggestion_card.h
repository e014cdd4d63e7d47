#pragma once

#include <QDialog>

class QPushButton;

namespace nearfit::ui {

/// Says what a search for a path came to. Stays open beside the view, which plays the path; closing it ends that.
class SuggestionCard : public QDialog {
  Q_OBJECT

 public:
  /// @param isFound  False: there is nothing to save or to feel.
  SuggestionCard(const QString& text, bool isFound, QWidget* parent);

  /// True as long as the proof is of the scene as it is.
  void setCertifiable(bool isIt);

 signals:
  void saveWanted();
  void certificateWanted();
  void guidanceWanted(bool isOn);

 private:
  QPushButton* certificate_ = nullptr;  ///< Null if nothing is found.
};

}  // namespace nearfit::ui
