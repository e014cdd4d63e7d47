#include "ui/panels/verdict/rules_dialog.h"

#include <QComboBox>
#include <QCompleter>
#include <QDialog>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <cstddef>

#include "core/base/error.h"
#include "ui/model/pair_findings_model.h"
#include "ui/widgets/font_scale.h"
#include "ui/widgets/number_field.h"

namespace nearfit::ui {
namespace {

/// Interference of a new press fit, its step and its limits [m]: fits of machine parts are of hundredths of a
/// millimetre.
constexpr double kUsualInterference = 2e-5, kInterferenceStep = 5e-6, kMinInterference = 1e-9;
constexpr int kInterferenceDecimals = 4;

/// Names that are offered while a pattern is typed; a longer list would take a while to make.
constexpr std::size_t kMaxOfferedNames = 5000;

QString kindName(PairRuleKind kind) {
  switch (kind) {
    case PairRuleKind::LeaveOut:
      return QObject::tr("Leave out");
    case PairRuleKind::SameGroup:
      return QObject::tr("Leave out parts of one group");
    case PairRuleKind::Touching:
      return QObject::tr("Meant to touch");
    case PairRuleKind::PressFit:
      break;
  }
  return QObject::tr("Press fit");
}

QString kindHelp(PairRuleKind kind) {
  switch (kind) {
    case PairRuleKind::LeaveOut:
      return QObject::tr("These parts are not checked with each other.");
    case PairRuleKind::SameGroup:
      return QObject::tr("Parts that are directly in one group are not checked with each other.");
    case PairRuleKind::Touching:
      return QObject::tr("These parts may touch; a clash is still a clash.");
    case PairRuleKind::PressFit:
      break;
  }
  return QObject::tr("These parts may touch, and overlap up to this depth.");
}

/// List of rules, and fields for the one that is chosen.
class RulesDialog : public QDialog {
 public:
  RulesDialog(const Scene& scene, const std::optional<PairRule>& added, QWidget* parent);
  const std::vector<PairRule>& rules() const { return rules_; }

 private:
  void setUpFields(const Scene& scene);
  void setUpLayout();
  QLineEdit* patternField(const char* name, const QStringList& offered, const QString& help);
  /// The chosen rule; null if there is none.
  PairRule* chosen();
  void add(const PairRule& rule);
  void removeChosen();
  void showChosen();
  void change();
  /// Says what is wrong with the rules, if anything, and lets them be accepted otherwise.
  void showFault();

  std::vector<PairRule> rules_;
  QListWidget* list_;
  QComboBox* kind_;
  QLineEdit *part_ = nullptr, *other_ = nullptr;
  NumberField* interference_;
  QLabel *help_, *fault_;
  QPushButton *add_, *remove_;
  QDialogButtonBox* buttons_;
};

RulesDialog::RulesDialog(const Scene& scene, const std::optional<PairRule>& added, QWidget* parent)
    : QDialog(parent),
      rules_(scene.pairRules()),
      list_(new QListWidget(this)),
      kind_(new QComboBox(this)),
      interference_(new NumberField(this)),
      help_(new QLabel(this)),
      fault_(new QLabel(this)),
      add_(new QPushButton(QObject::tr("&Add"), this)),
      remove_(new QPushButton(QObject::tr("Re&move"), this)),
      buttons_(new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this)) {
  setObjectName(QStringLiteral("rulesDialog"));
  setWindowTitle(QObject::tr("Rules of the check"));
  setUpFields(scene);
  setUpLayout();
  for (const PairRule& rule : rules_)
    list_->addItem(ruleText(rule));
  connect(list_, &QListWidget::currentRowChanged, this, [this] { showChosen(); });
  connect(kind_, QOverload<int>::of(&QComboBox::activated), this, [this] { change(); });
  // Names may be typed, or chosen among those that are offered.
  connect(part_, &QLineEdit::textChanged, this, [this] { change(); });
  connect(other_, &QLineEdit::textChanged, this, [this] { change(); });
  connect(interference_, &NumberField::quantityEdited, this, [this] { change(); });
  connect(add_, &QPushButton::clicked, this, [this] { add(PairRule()); });
  connect(remove_, &QPushButton::clicked, this, [this] { removeChosen(); });
  connect(buttons_, &QDialogButtonBox::accepted, this, [this] {
    interference_->settle();
    // What cannot be read stays to be corrected.
    if (!interference_->isEnabled() || !interference_->isFaulty()) accept();
  });
  connect(buttons_, &QDialogButtonBox::rejected, this, &QDialog::reject);
  if (added) {
    add(*added);
  } else {
    list_->setCurrentRow(rules_.empty() ? -1 : 0);
    showChosen();
  }
}

QLineEdit* RulesDialog::patternField(const char* name, const QStringList& offered, const QString& help) {
  auto* field = new QLineEdit(this);
  field->setObjectName(QLatin1String(name));
  field->setToolTip(help);
  auto* completer = new QCompleter(offered, field);
  completer->setFilterMode(Qt::MatchContains);
  field->setCompleter(completer);
  return field;
}

void RulesDialog::setUpFields(const Scene& scene) {
  list_->setObjectName(QStringLiteral("ruleList"));
  list_->setAccessibleName(QObject::tr("Rules"));
  list_->setMinimumSize(forFont(*this, 420), forFont(*this, 120));
  kind_->setObjectName(QStringLiteral("ruleKind"));
  kind_->setToolTip(QObject::tr("Effect of the rule on pairs of parts"));
  for (const PairRuleKind kind :
       {PairRuleKind::LeaveOut, PairRuleKind::SameGroup, PairRuleKind::Touching, PairRuleKind::PressFit})
    kind_->addItem(kindName(kind), static_cast<int>(kind));
  QStringList names;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (static_cast<std::size_t>(names.size()) == kMaxOfferedNames) break;
    names << QString::fromStdString(patternOf(part->name));
  }
  const QString help = QObject::tr(
      "Name of parts: * stands for any characters, ? for one; a backslash takes the next one as it is");
  part_ = patternField("rulePart", names, help);
  other_ = patternField("ruleOther", names, help);
  interference_->setObjectName(QStringLiteral("ruleInterference"));
  interference_->setTrimmed(true);
  interference_->setLength(kInterferenceDecimals);
  interference_->setQuantityRange(kMinInterference, kMaxInterference);
  interference_->setQuantityStep(kInterferenceStep);
  interference_->setHelp(QObject::tr("Max depth of the overlap that this fit allows"));
  interference_->showQuantity(kUsualInterference);
  add_->setObjectName(QStringLiteral("addRule"));
  add_->setToolTip(QObject::tr("Add a rule; choose below what it is for"));
  remove_->setObjectName(QStringLiteral("removeRule"));
  remove_->setToolTip(QObject::tr("Remove the chosen rule"));
  // Return in a field belongs to the field.
  add_->setAutoDefault(false);
  remove_->setAutoDefault(false);
}

void RulesDialog::setUpLayout() {
  for (QLabel* label : {help_, fault_}) {
    label->setWordWrap(true);
    label->setTextFormat(Qt::PlainText);
    label->setMinimumHeight(label->fontMetrics().lineSpacing());
  }
  help_->setObjectName(QStringLiteral("ruleHelp"));
  fault_->setObjectName(QStringLiteral("ruleFault"));
  auto* beside = new QVBoxLayout;
  beside->addWidget(add_);
  beside->addWidget(remove_);
  beside->addStretch();
  auto* top = new QHBoxLayout;
  top->addWidget(list_, 1);
  top->addLayout(beside);
  auto* form = new QFormLayout;
  form->addRow(QObject::tr("&Rule"), kind_);
  form->addRow(QObject::tr("&Parts"), part_);
  form->addRow(QObject::tr("&With"), other_);
  form->addRow(QObject::tr("&Up to"), interference_);
  auto* layout = new QVBoxLayout(this);
  layout->addLayout(top, 1);
  layout->addLayout(form);
  layout->addWidget(help_);
  layout->addWidget(fault_);
  layout->addWidget(buttons_);
}

PairRule* RulesDialog::chosen() {
  const int row = list_->currentRow();
  return row >= 0 && static_cast<std::size_t>(row) < rules_.size() ? &rules_[static_cast<std::size_t>(row)]
                                                                   : nullptr;
}

void RulesDialog::add(const PairRule& rule) {
  rules_.push_back(rule);
  list_->addItem(ruleText(rule));
  list_->setCurrentRow(list_->count() - 1);
  showChosen();
  kind_->setFocus();
}

void RulesDialog::removeChosen() {
  const int row = list_->currentRow();
  if (chosen() == nullptr) return;
  rules_.erase(rules_.begin() + row);
  delete list_->takeItem(row);
  showChosen();
}

void RulesDialog::showChosen() {
  const PairRule* rule = chosen();
  const PairRule shown = rule != nullptr ? *rule : PairRule();
  const bool hasNames = rule != nullptr && shown.kind != PairRuleKind::SameGroup;
  const QSignalBlocker blocker(kind_);
  kind_->setCurrentIndex(kind_->findData(static_cast<int>(shown.kind)));
  // A text that is set where it stands would move the cursor to its end.
  const auto show = [](QLineEdit& field, const std::string& text) {
    const QSignalBlocker silence(&field);
    if (field.text().toStdString() != text) field.setText(QString::fromStdString(text));
  };
  show(*part_, shown.part);
  show(*other_, shown.other);
  if (shown.kind == PairRuleKind::PressFit) interference_->showQuantity(shown.interference);
  kind_->setEnabled(rule != nullptr);
  part_->setEnabled(hasNames);
  other_->setEnabled(hasNames);
  interference_->setEnabled(rule != nullptr && shown.kind == PairRuleKind::PressFit);
  remove_->setEnabled(rule != nullptr);
  add_->setEnabled(rules_.size() < kMaxPairRules);
  help_->setText(rule != nullptr  ? kindHelp(shown.kind)
                 : rules_.empty() ? QObject::tr("There are no rules: each pair of parts is checked.")
                                  : QString());
  showFault();
}

void RulesDialog::change() {
  PairRule* rule = chosen();
  if (rule == nullptr) return;
  rule->kind = static_cast<PairRuleKind>(kind_->currentData().toInt());
  const bool hasNames = rule->kind != PairRuleKind::SameGroup;
  rule->part = hasNames ? part_->text().toStdString() : "*";
  rule->other = hasNames ? other_->text().toStdString() : "*";
  rule->interference = rule->kind == PairRuleKind::PressFit ? interference_->quantity() : 0.0;
  list_->currentItem()->setText(ruleText(*rule));
  showChosen();
}

void RulesDialog::showFault() {
  QString fault;
  try {
    checkPairRules(rules_);
  } catch (const UsageError& e) {
    fault = QObject::tr("%1: %2; %3")
                .arg(QString::fromStdString(e.where()), QString::fromStdString(e.problem()),
                     QString::fromStdString(e.remedy()));
  }
  fault_->setText(fault);
  buttons_->button(QDialogButtonBox::Ok)->setEnabled(fault.isEmpty());
}

}  // namespace

std::optional<std::vector<PairRule>> askForRules(const Scene& scene, const std::optional<PairRule>& added,
                                                 QWidget* parent) {
  RulesDialog dialog(scene, added, parent);
  return dialog.exec() == QDialog::Accepted ? std::optional(dialog.rules()) : std::nullopt;
}

}  // namespace nearfit::ui
