#include "ui/panels/view/feeling_view.h"

#include <QAction>
#include <QActionGroup>
#include <QMenu>
#include <QSettings>

#include "ui/view3d/view_detail.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/make_action.h"

namespace nearfit::ui {
namespace {

const QString kLegend = QStringLiteral("view/legend"), kQuality = QStringLiteral("view/feelQuality");

}  // namespace

FeelingView::FeelingView(Viewport& view, QWidget* window)
    : QObject(window),
      view_(view),
      legend_(
          makeSwitch(this, "legend", tr("Lege&nd"), {}, QSettings().value(kLegend, true).toBool(),
                     tr("Explain colours and arrows while a part is in hand; drag the legend to move it"))),
      quality_(new QMenu(tr("&Quality while feeling"), window)) {
  view_.setLegendVisible(legend_->isChecked());
  connect(legend_, &QAction::toggled, this, [this](bool isOn) {
    QSettings().setValue(kLegend, isOn);
    view_.setLegendVisible(isOn);
  });
  setUpQualities();
}

void FeelingView::setUpQualities() {
  quality_->setObjectName(QStringLiteral("qualityMenu"));
  auto* group = new QActionGroup(quality_);
  const QString stored = QSettings().value(kQuality).toString();
  const auto add = [&](FeelQuality quality, const QString& word, const QString& text,
                       const QString& toolTip) {
    QAction* action = quality_->addAction(text);
    action->setObjectName(QStringLiteral("quality-") + word);
    action->setToolTip(toolTip);
    action->setCheckable(true);
    group->addAction(action);
    connect(action, &QAction::triggered, this, [this, quality, word] {
      QSettings().setValue(kQuality, word);
      view_.detail().setFeelQuality(quality);
      view_.requestRender();
    });
    if (stored != word && (quality != FeelQuality::Balanced || group->checkedAction() != nullptr)) return;
    action->setChecked(true);
    view_.detail().setFeelQuality(quality);
  };
  add(FeelQuality::Full, QStringLiteral("full"), tr("&Full"),
      tr("Draw every triangle, however long that takes"));
  add(FeelQuality::Balanced, QStringLiteral("balanced"), tr("&Balanced"),
      tr("Draw everything unless the scene is large; holes and outlines stay"));
  add(FeelQuality::Fast, QStringLiteral("fast"), tr("Fa&st"),
      tr("Draw large parts coarsely, so that the view keeps up with the hand"));
}

}  // namespace nearfit::ui
