#pragma once

#include <QDialog>
#include <QTimer>

#include "ui/view3d/view_picture.h"

class QCheckBox;
class QComboBox;
class QDialogButtonBox;
class QLabel;
class QSpinBox;

namespace nearfit::ui {

/// Asks how a picture of the view should look (size, background, what besides the parts), with a small
/// preview. Remembers the choices from one time to the next.
class PictureDialog : public QDialog {
  Q_OBJECT

 public:
  /// @param pictures  Must outlive this.
  PictureDialog(ViewPicture& pictures, QWidget* parent);

  /// Returns the style that the user chose.
  PictureStyle style() const;
  /// True if the picture is for the clipboard, not for a file.
  bool isForClipboard() const noexcept { return isForClipboard_; }

  /// Returns the style chosen last; its size may be too large for the present view.
  static PictureStyle remembered();

 private:
  void setUpFields();
  void setUpButtons();
  void restore();
  void remember() const;
  void chooseSize();
  void showSize();
  void showPreview();

  ViewPicture& pictures_;
  const QSize shown_, largest_;
  QComboBox *size_, *ground_;
  QSpinBox* width_;
  QLabel *height_, *preview_;
  QCheckBox *axes_, *labels_;
  QTimer later_;
  bool isForClipboard_ = false;
};

}  // namespace nearfit::ui
