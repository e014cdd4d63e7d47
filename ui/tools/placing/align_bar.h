#pragma once

#include "core/placing/feature_pick.h"
#include "ui/widgets/view_bar.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QPushButton;

namespace nearfit::ui {

class NumberField;

/// The align tool's bar: prompt, filter, flip, distance, apply and cancel.
class AlignBar : public ViewBar {
  Q_OBJECT

 public:
  explicit AlignBar(QWidget* view);

  /// Shows what to do next.
  /// @param hint  The feature under the pointer; may be empty.
  void showPrompt(const QString& prompt, const QString& hint);
  /// Shows the options of the picked pair; hides them before there is one.
  /// @param isPicked   Both features are picked.
  /// @param canFlip    Flipping makes a difference.
  /// @param canOffset  A distance can be left between them.
  void showPair(bool isPicked, bool canFlip, bool canOffset);
  /// Resets flip and distance and hides the options.
  void reset();

  FeatureFilter filter() const;
  /// False while flipping is not possible.
  bool isFlipped() const;
  /// Distance between the features [m].
  double offset() const;

 signals:
  /// Emitted when the user chose which features can be picked.
  void filterChosen(nearfit::FeatureFilter filter);
  /// Emitted when flip or distance changed.
  void optionsEdited();
  /// Emitted by Apply; not while the distance cannot be read.
  void applied();
  /// Emitted by Cancel.
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
