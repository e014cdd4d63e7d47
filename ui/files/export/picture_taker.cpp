#include "ui/files/export/picture_taker.h"

#include <QAction>
#include <QApplication>
#include <QClipboard>
#include <QFileInfo>
#include <QImage>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "ui/files/export/picture_dialog.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/picture_file.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/save_file.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

QString sizeText(const QImage& picture) {
  return QObject::tr("%1 × %2 pixels").arg(picture.width()).arg(picture.height());
}

}  // namespace

PictureTaker::PictureTaker(const Session& session, ViewPicture& pictures, QWidget* window)
    : QObject(window),
      session_(session),
      pictures_(pictures),
      window_(window),
      save_(new QAction(icon(QStringLiteral("picture")), tr("Save p&icture…"), this)),
      copy_(new QAction(tr("Cop&y picture"), this)) {
  save_->setObjectName(QStringLiteral("savePicture"));
  save_->setShortcut(QKeySequence(QStringLiteral("Ctrl+Shift+P")));
  setHelp(*save_, tr("Save a picture of the view, in any size"));
  copy_->setObjectName(QStringLiteral("copyPicture"));
  copy_->setShortcut(QKeySequence(QStringLiteral("Ctrl+Alt+C")));
  setHelp(*copy_, tr("Copy a picture of the view to the clipboard, with the options of the last saved one"));
  connect(save_, &QAction::triggered, this, &PictureTaker::askAndSave);
  connect(copy_, &QAction::triggered, this,
          [this] { putOnClipboard(pictures_.take(PictureDialog::remembered())); });
}

PictureTaker::~PictureTaker() = default;

void PictureTaker::askAndSave() {
  if (task_.isRunning()) return;
  PictureDialog dialog(pictures_, window_);
  if (dialog.exec() != QDialog::Accepted) return;
  // Take the present view: a part in hand moves on while a file is chosen.
  const QImage picture = pictures_.take(dialog.style());
  if (dialog.isForClipboard()) {
    putOnClipboard(picture);
  } else {
    saveTo(picture);
  }
}

void PictureTaker::saveTo(const QImage& picture) {
  const QString name = session_.file().empty() ? QStringLiteral("nearfit") : fromPath(session_.file().stem());
  SaveRequest request{tr("Save picture"),
                      Preferences::lastFolder() + QChar('/') + name + QStringLiteral(".png"),
                      {tr("PNG pictures (*.png)")},
                      {QStringLiteral("png")}};
  if (!picture.hasAlphaChannel()) {
    request.filters << tr("JPEG pictures (*.jpg *.jpeg)");
    request.suffixes << QStringLiteral("jpg") << QStringLiteral("jpeg");
  }
  if (const std::optional<QString> file = askForSave(request, window_)) write(picture, *file);
}

void PictureTaker::write(QImage picture, const QString& file) {
  picture.setText(QStringLiteral("Software"), QStringLiteral("Nearfit"));
  const QString told = tr("Saved %1, %2").arg(QFileInfo(file).fileName(), sizeText(picture));
  const auto job = [picture = std::move(picture), file](const ProgressCallback&) {
    writePicture(picture, file);
  };
  task_.run(job, [this, file, told](const std::exception_ptr& error) {
    if (error) {
      emit failed(describe(tr("The picture was not saved."), error));
      return;
    }
    Preferences::rememberFolderOf(file);
    emit noted(told);
  });
}

void PictureTaker::putOnClipboard(const QImage& picture) {
  if (picture.isNull()) return;
  QApplication::clipboard()->setImage(picture);
  emit noted(tr("Copied a picture of the view, %1").arg(sizeText(picture)));
}

}  // namespace nearfit::ui
