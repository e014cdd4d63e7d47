#include "ui/panels/feel/locks_page.h"

#include <QCheckBox>
#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QStandardItemModel>
#include <QVBoxLayout>

#include "core/haptics/motion_freedom.h"

namespace nearfit::ui {

LocksPage::LocksPage(const QString& prefix, QWidget* parent)
    : FeelPage(parent), freedom_(new QComboBox(this)) {
  freedom_->setObjectName(prefix + QStringLiteral("freedom"));
  freedom_->setAccessibleName(tr("Allowed motion"));
  freedom_->setToolTip(tr("Motions of the hand that the part follows; also for the manual hand"));
  freedom_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  // In the order of MotionFreedom.
  freedom_->addItems({tr("Moves and rotates freely"), tr("In the XY plane"), tr("In the YZ plane"),
                      tr("In the ZX plane"), tr("Along X only"), tr("Along Y only"), tr("Along Z only"),
                      tr("Moves without rotating"), tr("Rotates in place"), tr("Other locks")});
  auto* model = qobject_cast<QStandardItemModel*>(freedom_->model());
  model->item(static_cast<int>(MotionFreedom::Other))->setEnabled(false);
  connect(freedom_, QOverload<int>::of(&QComboBox::activated), this, [this](int row) {
    HapticSettings next = settings();
    next.mapping = withFreedom(next.mapping, static_cast<MotionFreedom>(row));
    replace(next);
  });
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  layout->addWidget(freedom_);
  layout->addLayout(makeLocks(prefix));
}

QGridLayout* LocksPage::makeLocks(const QString& prefix) {
  const QString axes[3] = {QStringLiteral("X"), QStringLiteral("Y"), QStringLiteral("Z")};
  auto* locks = new QGridLayout;
  locks->setHorizontalSpacing(8);
  locks->setVerticalSpacing(4);
  locks->addWidget(new QLabel(tr("Lock"), this), 0, 0);
  locks->addWidget(new QLabel(tr("Lock rotation"), this), 1, 0);
  // Row by row, as the Tab key goes.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const QString& name = axes[axis];
    QCheckBox* move = addSwitch(
        prefix + QStringLiteral("lock") + name, name, tr("The hand does not move along %1").arg(name),
        [axis](HapticSettings& s) -> bool& { return s.mapping.translationLocks[axis]; });
    move->setAccessibleName(move->toolTip());
    locks->addWidget(move, 0, static_cast<int>(axis) + 1);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const QString& name = axes[axis];
    QCheckBox* turn = addSwitch(prefix + QStringLiteral("lockR") + name.toLower(), name,
                                tr("The hand does not rotate about %1").arg(name),
                                [axis](HapticSettings& s) -> bool& { return s.mapping.rotationLocks[axis]; });
    turn->setAccessibleName(turn->toolTip());
    locks->addWidget(turn, 1, static_cast<int>(axis) + 1);
  }
  locks->setColumnStretch(4, 1);
  return locks;
}

void LocksPage::refresh() {
  const QSignalBlocker quiet(freedom_);
  freedom_->setCurrentIndex(static_cast<int>(freedomOf(settings().mapping)));
}

}  // namespace nearfit::ui
