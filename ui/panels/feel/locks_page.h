#pragma once

#include "ui/panels/feel/feel_page.h"

class QComboBox;
class QGridLayout;

namespace nearfit::ui {

/// Chooses which motions of the hand count: planes and axes by name, and each lock by itself.
class LocksPage : public FeelPage {
  Q_OBJECT

 public:
  /// @param prefix  Prefix of the object names, since there are several such pages.
  explicit LocksPage(const QString& prefix, QWidget* parent = nullptr);

 protected:
  void refresh() override;

 private:
  QGridLayout* makeLocks(const QString& prefix);

  QComboBox* freedom_;
};

}  // namespace nearfit::ui
