#include "ui/files/export/report_dialog.h"

#include <QDialogButtonBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QVBoxLayout>

#include "core/report/html/fit_report.h"
#include "ui/widgets/font_scale.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/preferences.h"

namespace nearfit::ui {
namespace {

/// More findings than this a scene has where something else is wrong; all of them can be asked for.
constexpr int kMostPictures = 9999;

}  // namespace

ReportDialog::ReportDialog(double threshold, QWidget* parent)
    : QDialog(parent),
      threshold_(new NumberField(this)),
      pictures_(new QSpinBox(this)),
      path_(new QLineEdit(this)),
      certificate_(new QLineEdit(this)) {
  setObjectName(QStringLiteral("reportDialog"));
  setWindowTitle(tr("Report"));
  auto* text = new QLabel(tr("Checks all pairs of visible parts by the rules of the scene, and writes one "
                             "HTML file with the verdict, pictures, "
                             "tables, hashes of all inputs, and what was not checked. A browser shows it and "
                             "prints it, also as PDF."),
                          this);
  text->setWordWrap(true);
  threshold_->setObjectName(QStringLiteral("reportThreshold"));
  threshold_->setLength(4);
  threshold_->setTrimmed(true);
  threshold_->setQuantityRange(0.0, Preferences::kMaxCheckThreshold);
  threshold_->setQuantityStep(1e-4);
  threshold_->showQuantity(threshold);
  threshold_->setHelp(tr("Pairs of parts that are no farther apart are listed and shown"));
  pictures_->setObjectName(QStringLiteral("reportPictures"));
  pictures_->setRange(0, kMostPictures);
  pictures_->setSpecialValueText(tr("all"));
  pictures_->setValue(static_cast<int>(kDefaultPicturedFindings));
  pictures_->setToolTip(
      tr("So many findings are shown in pictures, the worst first; 0: all of them. Each takes about "
         "a hundred kilobytes of the file"));
  path_->setObjectName(QStringLiteral("reportPath"));
  certificate_->setObjectName(QStringLiteral("reportCertificate"));
  path_->setToolTip(
      tr("A path file, such as nearfit-cli path makes of a recording: the clearance along it is plotted"));
  certificate_->setToolTip(tr("The certificate of the path: it is proven anew"));
  for (QLineEdit* field : {path_, certificate_})
    field->setPlaceholderText(tr("none"));

  auto* form = new QFormLayout;
  form->addRow(tr("&Threshold"), threshold_);
  form->addRow(tr("P&ictures of findings"), pictures_);
  auto* pathLabel = new QLabel(tr("&Path"), this);
  pathLabel->setBuddy(path_);
  form->addRow(pathLabel, makeFileField(*path_, tr("Path"), tr("Paths (*.nfpath)")));
  auto* certificateLabel = new QLabel(tr("&Certificate"), this);
  certificateLabel->setBuddy(certificate_);
  form->addRow(certificateLabel,
               makeFileField(*certificate_, tr("Certificate"), tr("Certificates (*.nfcert)")));
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Save | QDialogButtonBox::Cancel, this);
  buttons->button(QDialogButtonBox::Save)->setText(tr("Report…"));
  connect(buttons, &QDialogButtonBox::accepted, this, [this] {
    threshold_->settle();
    // What cannot be read stays to be corrected.
    if (!threshold_->isFaulty()) accept();
  });
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* column = new QVBoxLayout(this);
  column->addWidget(text);
  column->addLayout(form);
  column->addWidget(buttons);
  setMinimumWidth(forFont(*this, 440));
}

QWidget* ReportDialog::makeFileField(QLineEdit& field, const QString& title, const QString& filter) {
  auto* row = new QWidget(this);
  auto* choose = new QPushButton(tr("Choose…"), row);
  choose->setObjectName(field.objectName() + QStringLiteral("Choose"));
  choose->setAccessibleName(tr("Choose: %1").arg(title));
  choose->setAutoDefault(false);
  auto* layout = new QHBoxLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(&field);
  layout->addWidget(choose);
  connect(choose, &QPushButton::clicked, this, [this, &field, title, filter] {
    const QString file = QFileDialog::getOpenFileName(this, title, Preferences::lastFolder(), filter);
    if (file.isEmpty()) return;
    Preferences::rememberFolderOf(file);
    field.setText(file);
  });
  return row;
}

double ReportDialog::threshold() const {
  return threshold_->quantity();
}

std::size_t ReportDialog::pictures() const {
  return static_cast<std::size_t>(pictures_->value());
}

QString ReportDialog::pathFile() const {
  return path_->text();
}

QString ReportDialog::certificateFile() const {
  return certificate_->text();
}

}  // namespace nearfit::ui
