#include "ui/panels/suggest/suggest_dialog.h"

#include <QCheckBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QLabel>
#include <QPushButton>
#include <QRadioButton>
#include <QVBoxLayout>
#include <cmath>

#include "ui/widgets/font_scale.h"
#include "ui/widgets/names.h"
#include "ui/widgets/number_field.h"

namespace nearfit::ui {
namespace {

/// Separations that can be asked for [m]: rounding of far scenes is checked by the search.
constexpr double kMinSeparation = 1e-9, kMaxSeparation = 10.0;
/// Times that can be asked for [s].
constexpr double kMinSeconds = 1.0, kMaxSeconds = 3600.0;

/// A separation is offered in steps of this [m], so that it can be read: two decimals of a micrometre, far less than any part
/// is made to.
constexpr double kSeparationStep = 1e-8;
/// Share of a step by which products of it are rounded: it must not become a step more.
constexpr double kStepRounding = 1e-6;

/// Rounds up: less may drown in the rounding of far scenes.
double readableSeparation(double separation) {
  return std::ceil(separation / kSeparationStep - kStepRounding) * kSeparationStep;
}

class SuggestDialog : public QDialog {
 public:
  SuggestDialog(const QString& name, const SuggestionRequest& first, QWidget* parent);
  SuggestionRequest request() const;

 private:
  QLayout* makeGoals(const SuggestionRequest& first);
  QLayout* makeFields(const SuggestionRequest& first);

  QRadioButton *out_, *toDrawn_;
  NumberField *seconds_, *separation_;
  QCheckBox* turns_;
};

SuggestDialog::SuggestDialog(const QString& name, const SuggestionRequest& first, QWidget* parent)
    : QDialog(parent),
      out_(new QRadioButton(QObject::tr("&Out of the assembly"), this)),
      toDrawn_(new QRadioButton(QObject::tr("To where it was &drawn"), this)),
      seconds_(new NumberField(this)),
      separation_(new NumberField(this)),
      turns_(new QCheckBox(QObject::tr("It may &turn"), this)) {
  setObjectName(QStringLiteral("suggestDialog"));
  setWindowTitle(QObject::tr("Suggest path"));
  auto* text = new QLabel(
      breakable(QObject::tr("Looks for a way of “%1” among the other visible parts, from where it is.")
                    .arg(shortName(name))),
      this);
  text->setTextFormat(Qt::PlainText);
  text->setWordWrap(true);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
  buttons->button(QDialogButtonBox::Ok)->setText(QObject::tr("Search"));
  connect(buttons, &QDialogButtonBox::accepted, this, [this] {
    seconds_->settle();
    separation_->settle();
    // What cannot be read stays to be corrected.
    if (!seconds_->isFaulty() && !separation_->isFaulty()) accept();
  });
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(text);
  layout->addLayout(makeGoals(first));
  layout->addLayout(makeFields(first));
  layout->addWidget(buttons);
  setMinimumWidth(forFont(*this, 380));
}

QLayout* SuggestDialog::makeGoals(const SuggestionRequest& first) {
  out_->setObjectName(QStringLiteral("suggestOut"));
  out_->setToolTip(QObject::tr("Until the box around it is clear of the box around all others"));
  toDrawn_->setObjectName(QStringLiteral("suggestToDrawn"));
  toDrawn_->setToolTip(
      QObject::tr("Where its CAD document places it, or where the coordinates of its mesh file are"));
  (first.goal == SuggestionRequest::Goal::Out ? out_ : toDrawn_)->setChecked(true);
  auto* goals = new QVBoxLayout;
  goals->addWidget(out_);
  goals->addWidget(toDrawn_);
  return goals;
}

QLayout* SuggestDialog::makeFields(const SuggestionRequest& first) {
  seconds_->setObjectName(QStringLiteral("suggestSeconds"));
  seconds_->setUnit(QStringLiteral(" s"));
  seconds_->setDecimals(0);
  seconds_->setQuantityRange(kMinSeconds, kMaxSeconds);
  seconds_->setQuantityStep(10.0);
  seconds_->setHelp(QObject::tr("The search, and making its path shorter, take no longer than this"));
  seconds_->showQuantity(first.seconds);
  separation_->setObjectName(QStringLiteral("suggestSeparation"));
  separation_->setLength(6);
  separation_->setTrimmed(true);
  separation_->setQuantityRange(kMinSeparation, kMaxSeparation);
  separation_->setQuantityStep(1e-5);
  separation_->setHelp(QObject::tr("Distance to all other visible parts that is proven all along the path"));
  separation_->showQuantity(first.separation);
  turns_->setObjectName(QStringLiteral("suggestTurns"));
  turns_->setToolTip(QObject::tr("Without it, the part is only shifted"));
  turns_->setChecked(first.mayTurn);
  auto* form = new QFormLayout;
  form->addRow(QObject::tr("T&ime"), seconds_);
  form->addRow(QObject::tr("S&eparation"), separation_);
  form->addRow(QString(), turns_);
  return form;
}

SuggestionRequest SuggestDialog::request() const {
  return {out_->isChecked() ? SuggestionRequest::Goal::Out : SuggestionRequest::Goal::ToDrawn,
          seconds_->quantity(), separation_->quantity(), turns_->isChecked()};
}

}  // namespace

std::optional<SuggestionRequest> askForSuggestion(const QString& name, double separation, QWidget* parent) {
  static SuggestionRequest last;
  SuggestionRequest first = last;
  first.separation = readableSeparation(separation);
  SuggestDialog dialog(name, first, parent);
  if (dialog.exec() != QDialog::Accepted) return std::nullopt;
  last = dialog.request();
  return last;
}

}  // namespace nearfit::ui
