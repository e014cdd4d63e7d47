#pragma once

#include "core/placing/feature_pick.h"
#include "ui/view_bar.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QPushButton;

namespace nearfit::ui {

class NumberField;

/// What the align tool asks for, over the lower edge of the view: what to point at, flip, distance, apply.
class AlignBar : public ViewBar {
  Q_OBJECT

 public:
  explicit AlignBar(QWidget* view);

  /// @param hint  What is under the pointer; may be empty.
  void showPrompt(const QString& prompt, const QString& hint);
  /// What can be chosen of the pair that is picked; nothing of it before there is one.
  void showPair(bool isPicked, bool canFlip, bool canOffset);
  void reset();

  FeatureFilter filter() const;
  bool isFlipped() const;
  /// [m]
  double offset() const;

 signals:
  void filterChosen(nearfit::FeatureFilter filter);
  /// Flip or distance.
  void optionsEdited();
  void applied();
  void cancelled();

 private:
  void setUpFields();

  QLabel *prompt_, *hint_;
  QComboBox* filter_;
  QCheckBox* flip_;
  QLabel* offsetLabel_;
  NumberField* offset_;
  QPushButton *apply_, *cancel_;
};

}  // namespace nearfit::ui
