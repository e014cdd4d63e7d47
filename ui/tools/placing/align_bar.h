#pragma once

#include <optional>

#include "core/placing/feature_pick.h"
#include "ui/widgets/view_bar.h"

class QCheckBox;
class QComboBox;
class QLabel;
class QPushButton;

namespace nearfit::ui {

class NumberField;

/// The align tool's bar: prompt, filter, flip, distance, keep, apply and cancel.
class AlignBar : public ViewBar {
  Q_OBJECT

 public:
  explicit AlignBar(QWidget* view);

  /// Shows what to do next.
  /// @param hint  The feature under the pointer; may be empty.
  void showPrompt(const QString& prompt, const QString& hint);
  /// Choices offered for a picked pair.
  struct Options {
    bool canFlip = false;    ///< Flipping makes a difference.
    bool canOffset = false;  ///< A distance can be left between them.
    bool canKeep = false;    ///< A joint can keep them together.
  };
  /// Shows the options of the picked pair; nullopt hides them, before there is one.
  void showPair(const std::optional<Options>& options);
  /// Sets whether the result can be applied; only while there is a pair.
  void setApplicable(bool isApplicable);
  /// Resets flip, distance and keep, and hides the options.
  /// @param hasFilter  The user chooses what can be picked.
  void reset(bool hasFilter);

  FeatureFilter filter() const;
  /// False while flipping is not possible.
  bool isFlipped() const;
  /// False while keeping is not possible.
  bool isKept() const;
  /// Distance between the features [m].
  double offset() const;

 signals:
  /// Emitted when the user chose which features can be picked.
  void filterChosen(nearfit::FeatureFilter filter);
  /// Emitted when flip, distance or keep changed.
  void optionsEdited();
  /// Emitted by Apply; not while the distance cannot be read.
  void applied();
  /// Emitted by Cancel.
  void cancelled();

 private:
  void setUpFields();
  void colourHint(const QColor& colour);

  QLabel *prompt_, *hint_;
  QComboBox* filter_;
  QCheckBox* flip_;
  QLabel* offsetLabel_;
  NumberField* offset_;
  QCheckBox* keep_;
  QPushButton *apply_, *cancel_;
};

}  // namespace nearfit::ui
