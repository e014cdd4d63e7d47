#pragma once

#include <QObject>

#include "core/session.h"
#include "ui/background_task.h"
#include "ui/dialogs/error_box.h"

class QAction;
class QImage;

namespace nearfit::ui {

class ViewPicture;

/// Takes pictures of the view away: to a file (PNG or JPEG) or the clipboard. Files are written in another
/// thread, whole or not at all.
class PictureTaker : public QObject {
  Q_OBJECT

 public:
  /// All outlive this. @param session  After whose file pictures are named.
  PictureTaker(const Session& session, ViewPicture& pictures, QWidget* window);
  ~PictureTaker() override;

  /// *Save picture…*
  QAction* save() const noexcept { return save_; }
  /// *Copy picture*: looks as the last one that was saved.
  QAction* copy() const noexcept { return copy_; }

 signals:
  void failed(const nearfit::ui::Failure& failure);
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
