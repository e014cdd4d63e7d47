#pragma once

#include <QDialog>

namespace nearfit::ui {

/// Says what a search for a path came to. Stays open beside the view, which plays the path; closing it ends that.
class SuggestionCard : public QDialog {
  Q_OBJECT

 public:
  /// @param isFound  False: there is nothing to save or to feel.
  SuggestionCard(const QString& text, bool isFound, QWidget* parent);

 signals:
  void saveWanted();
  void guidanceWanted(bool isOn);
};

}  // namespace nearfit::ui
