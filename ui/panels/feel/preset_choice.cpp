#include "ui/panels/feel/preset_choice.h"

#include <QAction>
#include <QComboBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QMessageBox>
#include <QPushButton>
#include <QSignalBlocker>
#include <QStandardItemModel>
#include <QString>
#include <QVBoxLayout>
#include <functional>

#include "ui/model/preset_store.h"
#include "ui/widgets/font_scale.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Asks for a name and says at each keystroke whether it is accepted.
class PresetNameDialog : public QDialog {
 public:
  /// @param title   Title of the dialog.
  /// @param button  Text of the button that accepts the name.
  explicit PresetNameDialog(const QString& title, const QString& button, QWidget* parent = nullptr);

  struct Verdict {
    bool isRefused = false;
    QString note;  ///< Why, or what will happen; may be empty.
  };
  using Judge = std::function<Verdict(const QString& name)>;
  /// Shows the dialog. Returns the name without surrounding spaces; empty if the user cancels.
  QString ask(const QString& proposal, const Judge& judge);

 private:
  void look();

  QLineEdit* name_;
  QLabel* note_;
  QPushButton* accept_;
  Judge judge_;
};

PresetNameDialog::PresetNameDialog(const QString& title, const QString& button, QWidget* parent)
    : QDialog(parent), name_(new QLineEdit(this)), note_(new QLabel(this)) {
  setObjectName(QStringLiteral("presetNameDialog"));
  setWindowTitle(title);
  auto* label = new QLabel(tr("&Name of the preset"), this);
  label->setBuddy(name_);
  name_->setObjectName(QStringLiteral("presetName"));
  note_->setObjectName(QStringLiteral("presetNameNote"));
  note_->setWordWrap(true);
  note_->setMinimumHeight(2 * note_->fontMetrics().lineSpacing());
  note_->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  note_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kWarning.name()));
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel, this);
  accept_ = buttons->button(QDialogButtonBox::Ok);
  accept_->setText(button);
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(name_, &QLineEdit::textChanged, this, &PresetNameDialog::look);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(label);
  layout->addWidget(name_);
  layout->addWidget(note_);
  layout->addWidget(buttons);
  setMinimumWidth(forFont(*this, 360));
}

QString PresetNameDialog::ask(const QString& proposal, const Judge& judge) {
  judge_ = judge;
  name_->setText(proposal);
  name_->selectAll();
  look();
  return exec() == QDialog::Accepted ? name_->text().trimmed() : QString();
}

void PresetNameDialog::look() {
  const QString name = name_->text().trimmed();
  const Verdict verdict = judge_(name);
  accept_->setEnabled(!name.isEmpty() && !verdict.isRefused);
  note_->setText(name.isEmpty() ? QString() : verdict.note);
}

}  // namespace

PresetChoice::PresetChoice(const char* name, PresetStore& presets, QWidget* parent)
    : QWidget(parent), presets_(presets), box_(new QComboBox(this)) {
  box_->setObjectName(QLatin1String(name));
  box_->setAccessibleName(tr("Preset"));
  box_->setToolTip(tr("How hard contact feels. Every preset stays within your device's limits."));
  box_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  setFocusProxy(box_);
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  layout->addWidget(box_, 1);
  connect(box_, QOverload<int>::of(&QComboBox::activated), this, [this](int row) {
    const auto index = static_cast<std::size_t>(row);
    if (index >= presets_.presets().size()) return showInForce();
    const FeelPreset preset = presets_.presets()[index];
    presets_.choose(preset);
    emit chosen(withPreset(settings_, preset), shownName(preset));
  });
  connect(&presets_, &PresetStore::changed, this, &PresetChoice::listPresets);
  connect(&presets_, &PresetStore::choiceChanged, this, &PresetChoice::showInForce);
  listPresets();
}

void PresetChoice::setManaged() {
  auto* menu = new QMenu(this);
  const auto add = [&](const char* name, const QString& text, const char* iconName, const QString& tip,
                       void (PresetChoice::*act)()) {
    QAction* action = menu->addAction(icon(QLatin1String(iconName)), text);
    action->setObjectName(QLatin1String(name));
    action->setToolTip(tip);
    connect(action, &QAction::triggered, this, act);
    return action;
  };
  add("savePreset", tr("&Save as…"), "save-as", tr("Save the current settings as a preset for any scene"),
      &PresetChoice::saveAs);
  rename_ =
      add("renamePreset", tr("Re&name…"), "rename", tr("Rename your preset"), &PresetChoice::renameChosen);
  delete_ = add("deletePreset", tr("&Delete"), "delete", tr("Delete your preset; scenes do not change"),
                &PresetChoice::deleteChosen);
  menu->setToolTipsVisible(true);
  menuButton_ = new QPushButton(tr("Manage"), this);
  menuButton_->setObjectName(QStringLiteral("presetMenu"));
  // Return in a field must not press it.
  menuButton_->setAutoDefault(false);
  menuButton_->setToolTip(tr("Save, rename and delete presets of your own"));
  menuButton_->setFocusPolicy(Qt::TabFocus);
  menuButton_->setMenu(menu);
  layout()->addWidget(menuButton_);
  showInForce();
}

void PresetChoice::showSettings(const HapticSettings& settings) {
  settings_ = settings;
  showInForce();
}

void PresetChoice::listPresets() {
  const QSignalBlocker quiet(box_);
  box_->clear();
  for (const FeelPreset& preset : presets_.presets())
    box_->addItem(shownName(preset));
  box_->addItem(tr("Custom"));
  // "Custom" shows by itself once something was changed: nobody can choose it.
  auto* model = qobject_cast<QStandardItemModel*>(box_->model());
  model->item(box_->count() - 1)->setEnabled(false);
  showInForce();
}

void PresetChoice::showInForce() {
  const QSignalBlocker quiet(box_);
  const FeelPreset* preset = presets_.inForce(settings_);
  const FeelPreset* first = presets_.presets().data();
  box_->setCurrentIndex(preset != nullptr ? static_cast<int>(preset - first) : box_->count() - 1);
  for (QAction* action : {rename_, delete_}) {
    if (action != nullptr) action->setEnabled(!chosenOwn().isEmpty());
  }
}

QString PresetChoice::chosenOwn() const {
  const FeelPreset* preset = presets_.inForce(settings_);
  return preset != nullptr && !preset->isOfStiffnessAlone ? QString::fromStdString(preset->name) : QString();
}

void PresetChoice::saveAs() {
  PresetNameDialog dialog(tr("Save preset"), tr("Save"), this);
  const QString own = chosenOwn();
  const QString name = dialog.ask(own.isEmpty() ? tr("My feel") : own, [this](const QString& wanted) {
    const QString refusal = presets_.refusalOf(wanted);
    if (!refusal.isEmpty()) return PresetNameDialog::Verdict{true, refusal};
    return PresetNameDialog::Verdict{
        false, presets_.isOwn(wanted) ? tr("This replaces your preset of the same name.") : QString()};
  });
  if (!name.isEmpty()) presets_.keep(name, settings_);
}

void PresetChoice::renameChosen() {
  PresetNameDialog dialog(tr("Rename preset"), tr("Rename"), this);
  const QString before = chosenOwn();
  const QString name = dialog.ask(before, [this, before](const QString& wanted) {
    const bool isTaken = wanted != before && presets_.isOwn(wanted);
    const QString refusal =
        isTaken ? tr("You already have a preset of this name.") : presets_.refusalOf(wanted);
    return PresetNameDialog::Verdict{!refusal.isEmpty(), refusal};
  });
  if (!name.isEmpty()) presets_.rename(before, name);
}

void PresetChoice::deleteChosen() {
  const QString name = chosenOwn();
  QMessageBox box(QMessageBox::Question, tr("Delete the preset"), tr("Delete the preset “%1”?").arg(name),
                  QMessageBox::Cancel, this);
  box.setObjectName(QStringLiteral("deletePresetBox"));
  box.setInformativeText(tr("Scenes that use it do not change."));
  auto* confirm = box.addButton(tr("Delete"), QMessageBox::DestructiveRole);
  confirm->setObjectName(QStringLiteral("confirmDeletePreset"));
  box.setDefaultButton(QMessageBox::Cancel);
  box.exec();
  if (box.clickedButton() == confirm) presets_.remove(name);
}

}  // namespace nearfit::ui
