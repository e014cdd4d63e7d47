#pragma once

#include <QObject>

#include "core/session/session.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

class QAction;
class QImage;

namespace nearfit::ui {

class ViewPicture;

/// Saves pictures of the view to a file (PNG or JPEG) or copies them to the clipboard. Files are written in
/// another thread, whole or not at all.
class PictureTaker : public QObject {
  Q_OBJECT

 public:
  /// @param session   Its file gives pictures their name; must outlive this.
  /// @param pictures  Must outlive this.
  /// @param window    Must outlive this.
  PictureTaker(const Session& session, ViewPicture& pictures, QWidget* window);
  ~PictureTaker() override;

  /// Returns the action *Save picture…*.
  QAction* save() const noexcept { return save_; }
  /// Returns the action *Copy picture*, which uses the style chosen last.
  QAction* copy() const noexcept { return copy_; }

 signals:
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);

 private:
  void askAndSave();
  void saveTo(const QImage& picture);
  void write(QImage picture, const QString& file);
  void putOnClipboard(const QImage& picture);

  const Session& session_;
  ViewPicture& pictures_;
  QWidget* window_;
  QAction *save_, *copy_;
  BackgroundTask task_;
};

}  // namespace nearfit::ui
