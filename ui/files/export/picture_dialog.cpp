#include "ui/files/export/picture_dialog.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QLabel>
#include <QPainter>
#include <QPushButton>
#include <QSettings>
#include <QSignalBlocker>
#include <QSpinBox>
#include <algorithm>
#include <cmath>

namespace nearfit::ui {
namespace {

using Ground = PictureStyle::Ground;

const QString kScaleKey = QStringLiteral("picture/scale"), kGroundKey = QStringLiteral("picture/ground"),
              kAxesKey = QStringLiteral("picture/axes"), kLabelsKey = QStringLiteral("picture/labels");

constexpr int kOwn = 0;  ///< Stands for a width of the user's own; other sizes are factors.
constexpr int kMinWidth = 64;
constexpr QSize kPreview(400, 250);
constexpr int kCheck = 8;  ///< Size of the squares that show through a transparent picture.

QPixmap framed(const QImage& picture, double ratio) {
  const QImage small = picture.scaled(kPreview * ratio, Qt::KeepAspectRatio, Qt::SmoothTransformation);
  QPixmap framed(small.size());
  framed.fill(Qt::white);
  QPainter painter(&framed);
  const int square = static_cast<int>(kCheck * ratio);
  for (int y = 0; y < framed.height(); y += square) {
    for (int x = (y / square) % 2 * square; x < framed.width(); x += 2 * square)
      painter.fillRect(x, y, square, square, QColor(0xd5, 0xd8, 0xdc));
  }
  painter.drawImage(0, 0, small);
  painter.end();
  framed.setDevicePixelRatio(ratio);
  return framed;
}

}  // namespace

PictureDialog::PictureDialog(ViewPicture& pictures, QWidget* parent)
    : QDialog(parent), pictures_(pictures), shown_(pictures.size()), largest_(pictures.largestSize()) {
  setObjectName(QStringLiteral("pictureDialog"));
  setWindowTitle(tr("Save picture"));
  setUpFields();
  setUpButtons();
  restore();
  showSize();
  // One preview for all changes at once, and none before the dialog is visible.
  later_.setSingleShot(true);
  later_.setInterval(0);
  connect(&later_, &QTimer::timeout, this, &PictureDialog::showPreview);
  connect(size_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, &PictureDialog::chooseSize);
  connect(width_, QOverload<int>::of(&QSpinBox::valueChanged), this, &PictureDialog::showSize);
  const auto look = [this] { later_.start(); };
  connect(ground_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, look);
  connect(axes_, &QCheckBox::toggled, this, look);
  connect(labels_, &QCheckBox::toggled, this, look);
  look();
}

void PictureDialog::setUpFields() {
  preview_ = new QLabel(this);
  preview_->setObjectName(QStringLiteral("picturePreview"));
  preview_->setAccessibleName(tr("Preview"));
  preview_->setFrameShape(QFrame::StyledPanel);
  preview_->setFixedSize(kPreview + 2 * QSize(preview_->frameWidth(), preview_->frameWidth()));
  preview_->setAlignment(Qt::AlignCenter);

  size_ = new QComboBox(this);
  size_->setObjectName(QStringLiteral("pictureSize"));
  size_->addItem(tr("As in the window"), 1);
  size_->addItem(tr("Twice as large"), 2);
  size_->addItem(tr("Four times as large"), 4);
  for (int i = size_->count() - 1; i > 0; --i) {
    if (shown_.width() * size_->itemData(i).toInt() > largest_.width()) size_->removeItem(i);
  }
  size_->addItem(tr("Custom width"), kOwn);
  width_ = new QSpinBox(this);
  width_->setObjectName(QStringLiteral("pictureWidth"));
  width_->setAccessibleName(tr("Width in pixels"));
  width_->setRange(std::min(kMinWidth, shown_.width()), largest_.width());
  width_->setSuffix(tr(" px"));
  width_->setToolTip(tr("Up to %1 × %2 pixels").arg(largest_.width()).arg(largest_.height()));
  height_ = new QLabel(this);
  height_->setObjectName(QStringLiteral("pictureHeight"));
  ground_ = new QComboBox(this);
  ground_->setObjectName(QStringLiteral("pictureGround"));
  ground_->addItem(tr("As in the window"), static_cast<int>(Ground::View));
  ground_->addItem(tr("White"), static_cast<int>(Ground::White));
  ground_->addItem(tr("Transparent"), static_cast<int>(Ground::Transparent));
  axes_ = new QCheckBox(tr("&Axes in the corner"), this);
  axes_->setObjectName(QStringLiteral("pictureAxes"));
  labels_ = new QCheckBox(tr("&Legend and measures"), this);
  labels_->setObjectName(QStringLiteral("pictureLabels"));
  labels_->setToolTip(tr("Legend of the minima and arrows with their values, measurements and scale bar"));

  auto* pixels = new QHBoxLayout;
  pixels->addWidget(width_);
  pixels->addWidget(height_);
  pixels->addStretch();
  auto* form = new QFormLayout;
  form->addRow(tr("&Size"), size_);
  form->addRow(tr("&Width"), pixels);
  qobject_cast<QLabel*>(form->labelForField(pixels))->setBuddy(width_);
  form->addRow(tr("&Background"), ground_);
  form->addRow(tr("Include"), axes_);
  form->addRow({}, labels_);
  auto* column = new QVBoxLayout(this);
  column->addWidget(preview_, 0, Qt::AlignHCenter);
  column->addLayout(form);
  column->setSizeConstraint(QLayout::SetFixedSize);
}

void PictureDialog::setUpButtons() {
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Save | QDialogButtonBox::Cancel, this);
  buttons->button(QDialogButtonBox::Save)->setText(tr("Save…"));
  QPushButton* copy = buttons->addButton(tr("&Copy"), QDialogButtonBox::ActionRole);
  copy->setObjectName(QStringLiteral("pictureCopy"));
  copy->setToolTip(tr("Copy this picture to the clipboard"));
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(copy, &QPushButton::clicked, this, [this] {
    isForClipboard_ = true;
    accept();
  });
  connect(this, &QDialog::accepted, this, &PictureDialog::remember);
  layout()->addWidget(buttons);
}

PictureStyle PictureDialog::remembered() {
  const QSettings settings;
  PictureStyle style;
  const double scale = settings.value(kScaleKey, 1.0).toDouble();
  if (std::isfinite(scale) && scale > 0.0) style.scale = scale;
  const int ground = settings.value(kGroundKey, 0).toInt();
  if (ground == static_cast<int>(Ground::White)) style.ground = Ground::White;
  if (ground == static_cast<int>(Ground::Transparent)) style.ground = Ground::Transparent;
  style.hasAxes = settings.value(kAxesKey, true).toBool();
  style.hasLabels = settings.value(kLabelsKey, true).toBool();
  return style;
}

void PictureDialog::restore() {
  const PictureStyle style = remembered();
  const double width =
      std::clamp(style.scale * shown_.width(), 1.0 * width_->minimum(), 1.0 * width_->maximum());
  width_->setValue(static_cast<int>(std::lround(width)));
  ground_->setCurrentIndex(ground_->findData(static_cast<int>(style.ground)));
  axes_->setChecked(style.hasAxes);
  labels_->setChecked(style.hasLabels);
}

void PictureDialog::remember() const {
  const PictureStyle style = this->style();
  QSettings settings;
  settings.setValue(kScaleKey, style.scale);
  settings.setValue(kGroundKey, static_cast<int>(style.ground));
  settings.setValue(kAxesKey, style.hasAxes);
  settings.setValue(kLabelsKey, style.hasLabels);
}

PictureStyle PictureDialog::style() const {
  return {static_cast<double>(width_->value()) / shown_.width(),
          static_cast<Ground>(ground_->currentData().toInt()), axes_->isChecked(), labels_->isChecked()};
}

void PictureDialog::chooseSize() {
  const int times = size_->currentData().toInt();
  if (times == kOwn) return width_->setFocus();
  width_->setValue(times * shown_.width());
}

void PictureDialog::showSize() {
  const int width = width_->value();
  const double height = std::round(static_cast<double>(width) * shown_.height() / shown_.width());
  height_->setText(tr("× %1 px").arg(static_cast<int>(height)));
  int row = size_->findData(kOwn);
  for (int i = 0; i < size_->count(); ++i) {
    if (const int times = size_->itemData(i).toInt(); times != kOwn && times * shown_.width() == width)
      row = i;
  }
  const QSignalBlocker quiet(size_);
  size_->setCurrentIndex(row);
}

void PictureDialog::showPreview() {
  PictureStyle style = this->style();
  style.scale = 1.0;
  preview_->setPixmap(framed(pictures_.preview(style), devicePixelRatioF()));
}

}  // namespace nearfit::ui
