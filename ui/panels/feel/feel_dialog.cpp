#include "ui/panels/feel/feel_dialog.h"

#include <QComboBox>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QLabel>
#include <QPushButton>
#include <QShowEvent>
#include <QStackedWidget>
#include <QTabWidget>
#include <QVBoxLayout>
#include <algorithm>

#include "core/scene/haptic_limits.h"
#include "core/scene/moving_body.h"
#include "ui/model/feel_mode.h"
#include "ui/panels/feel/feel_pages.h"
#include "ui/panels/feel/preset_choice.h"
#include "ui/panels/feel/space_mouse_page.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// The one number that counts in every mode.
class CutoffPage : public FeelPage {
 public:
  explicit CutoffPage(QWidget* parent) : FeelPage(parent) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(addNumber({"cutoff",
                                 tr("Range of the search for minima; also the rest length of springs"),
                                 {},
                                 kMinCutoff,
                                 kMaxCutoff,
                                 4,
                                 true},
                                [](HapticSettings& s) -> double& { return s.springs.cutoff; }));
  }
};

}  // namespace

FeelDialog::FeelDialog(PresetStore& presets, QWidget* parent)
    : QDialog(parent),
      contact_(new QStackedWidget(this)),
      proxy_(new ProxyPage(this)),
      springs_(new SpringPage(this)),
      weight_(new WeightPage(this)),
      workspace_(new WorkspacePage(this)),
      spaceMouse_(new SpaceMousePage(this)) {
  setObjectName(QStringLiteral("feelDialog"));
  setWindowTitle(tr("Feel settings"));
  QWidget* head = makeHead(presets);
  contact_->addWidget(proxy_);
  contact_->addWidget(springs_);
  auto* tabs = new QTabWidget(this);
  tabs->setObjectName(QStringLiteral("feelTabs"));
  tabs->setAccessibleName(tr("Feel settings"));
  tabs->addTab(contact_, tr("Contact"));
  tabs->addTab(weight_, tr("Weight"));
  tabs->addTab(workspace_, tr("Workspace"));
  tabs->addTab(spaceMouse_, tr("Space mouse"));
  refusal_ = new QLabel(this);
  refusal_->setObjectName(QStringLiteral("refusal"));
  refusal_->setWordWrap(true);
  refusal_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kWarning.name()));
  refusal_->hide();
  QWidget* buttons = makeButtons();
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(head);
  layout->addWidget(tabs, 1);
  layout->addWidget(refusal_);
  layout->addWidget(buttons);

  for (FeelPage* page : {cutoff_, static_cast<FeelPage*>(proxy_), static_cast<FeelPage*>(springs_),
                         static_cast<FeelPage*>(weight_), static_cast<FeelPage*>(workspace_)})
    connect(page, &FeelPage::edited, this, &FeelDialog::edit);
  connect(spaceMouse_, &SpaceMousePage::edited, this, &FeelDialog::rateEdited);
  connect(mode_, QOverload<int>::of(&QComboBox::activated), this,
          [this] { edit(withMode(settings_, mode_->currentData().value<FeelMode>())); });
  showScene({});
}

QWidget* FeelDialog::makeButtons() {
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close, this);
  revert_ = buttons->addButton(tr("Revert"), QDialogButtonBox::ResetRole);
  revert_->setObjectName(QStringLiteral("revert"));
  revert_->setToolTip(tr("Restore the settings from when this window was opened"));
  // Return accepts a number; it must not press a button too.
  for (QAbstractButton* button : buttons->buttons())
    qobject_cast<QPushButton*>(button)->setAutoDefault(false);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::close);
  connect(revert_, &QPushButton::clicked, this, [this] { edit(opened_); });
  return buttons;
}

void FeelDialog::showEvent(QShowEvent* event) {
  // The event also comes when the window returns from being minimised.
  if (!event->spontaneous()) opened_ = settings_;
  refresh();
  QDialog::showEvent(event);
}

QWidget* FeelDialog::makeHead(PresetStore& presets) {
  auto* head = new QWidget(this);
  preset_ = new PresetChoice("preset", presets, head);
  preset_->setManaged();
  connect(preset_, &PresetChoice::chosen, this, [this](const HapticSettings& settings, const QString& name) {
    settings_ = settings;
    refresh();
    emit presetChosen(settings, name);
  });
  mode_ = new QComboBox(head);
  mode_->setObjectName(QStringLiteral("mode"));
  addModes(*mode_);
  explanation_ = new QLabel(head);
  explanation_->setWordWrap(true);
  constexpr int kLines = 3;
  explanation_->setMinimumHeight(kLines * explanation_->fontMetrics().lineSpacing());
  explanation_->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  explanation_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));
  cutoff_ = new CutoffPage(head);
  auto* form = new QFormLayout(head);
  form->setContentsMargins(0, 0, 0, 0);
  form->addRow(tr("Preset"), preset_);
  form->addRow(tr("Mode"), mode_);
  form->addRow(explanation_);
  form->addRow(tr("Cutoff"), cutoff_);
  return head;
}

void FeelDialog::edit(const HapticSettings& settings) {
  settings_ = settings;
  refresh();
  emit settingsEdited(settings);
}

void FeelDialog::showScene(const Scene& scene) {
  settings_ = scene.haptics();
  showMovingPart(scene);
  refresh();
}

void FeelDialog::refresh() {
  const FeelMode mode = feelModeOf(settings_);
  showMode(*mode_, mode);
  preset_->showSettings(settings_);
  revert_->setEnabled(!(settings_ == opened_));
  explanation_->setText(explanationOf(mode));
  for (FeelPage* page : {cutoff_, static_cast<FeelPage*>(proxy_), static_cast<FeelPage*>(springs_),
                         static_cast<FeelPage*>(weight_), static_cast<FeelPage*>(workspace_)})
    page->showSettings(settings_);
  contact_->setCurrentWidget(mode == FeelMode::Proxy ? static_cast<QWidget*>(proxy_) : springs_);
}

void FeelDialog::showMovingPart(const Scene& scene) {
  const Part* part = scene.movingPart() ? scene.find(*scene.movingPart()) : nullptr;
  const Group* group = scene.movingGroup() ? scene.findGroup(*scene.movingGroup()) : nullptr;
  const std::string name = group != nullptr ? group->name : part != nullptr ? part->name : std::string();
  weight_->showMass(QString::fromStdString(name), massOfMoving(scene).mass);
  PartGeometryPtr geometry = part != nullptr ? part->geometry : nullptr;
  // Joining the meshes of a group may take long; until that is done, the part that leads stands for it.
  if (group != nullptr && isReadyToFeel(scene)) geometry = movingBody(scene).geometry;
  if (geometry == moving_) return;
  moving_ = geometry;
  basis_.metric = geometry != nullptr ? massMetric(geometry->mass, geometry->mesh) : MassMetric{};
  showBasis();
}

void FeelDialog::showRefusal(const QString& why) {
  refusal_->setText(why);
  refusal_->setVisible(!why.isEmpty());
  growToContent();
}

void FeelDialog::growToContent() {
  layout()->activate();
  resize(width(), std::max(height(), layout()->totalHeightForWidth(width())));
}

void FeelDialog::showRate(const RateSettings& settings) {
  spaceMouse_->showSettings(settings);
}

void FeelDialog::setDevice(const DeviceLimits& limits) {
  basis_.device = limits;
  showBasis();
}

void FeelDialog::showSnapshot(const ServoSnapshot& snapshot) {
  basis_.period = snapshot.period;
  basis_.inForce.reset();
  basis_.springs.reset();
  basis_.shares = {};
  if (snapshot.fault == ServoFault::None) {
    if (snapshot.mode == HapticMode::Proxy) basis_.inForce = snapshot.coupling;
    if (snapshot.mode == HapticMode::Springs) {
      basis_.springs = snapshot.areaCount;
      basis_.shares = snapshot.springShares;
    }
  }
  if (isVisible()) showBasis();
}

void FeelDialog::clearSnapshot() {
  const CouplingBasis usual;
  basis_.period = usual.period;
  basis_.inForce.reset();
  basis_.springs.reset();
  basis_.shares = {};
  showBasis();
}

void FeelDialog::showBasis() {
  proxy_->showBasis(basis_);
  springs_->showBasis(basis_);
}

}  // namespace nearfit::ui
