#include "ui/panels/view/view_actions.h"

#include <QAction>

#include "core/session/session.h"
#include "ui/model/selection.h"
#include "ui/panels/view/minima_menu.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/make_action.h"

namespace nearfit::ui {

ViewActions::ViewActions(Session& session, Selection& selection, Viewport& view, QWidget* window)
    : QObject(window),
      session_(session),
      selection_(selection),
      view_(view),
      minima_(new MinimaMenu(window)) {
  setUpLooking();
  setUpDrawing();
  connect(&selection_, &Selection::changed, this, &ViewActions::update);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { update(); });
  update();
}

void ViewActions::setUpLooking() {
  fit = makeAction(this, "fit", tr("&Fit all"), QStringLiteral("fit"), Qt::Key_F,
                   tr("Zoom the view to all parts"));
  connect(fit, &QAction::triggered, &view_, &Viewport::fit);
  fitSelection = makeAction(this, "fitSelection", tr("Fit se&lected"), QStringLiteral("fit"),
                            QStringLiteral("Shift+F"), tr("Zoom the view to the selected parts"));
  connect(fitSelection, &QAction::triggered, this, [this] {
    if (!selection_.parts().empty()) view_.fitParts(selection_.parts());
  });
  const auto add = [this](StandardView view, const char* name, const QString& text, const QString& iconName,
                          Qt::Key key, const QString& help) {
    QAction* action = makeAction(this, name, text, iconName, key, help);
    connect(action, &QAction::triggered, this, [this, view] { view_.setView(view); });
    views_ << action;
  };
  add(StandardView::Isometric, "viewIso", tr("&Isometric"), QStringLiteral("view-iso"), Qt::Key_0,
      tr("Look from the corner between front, right and top"));
  add(StandardView::Front, "viewFront", tr("F&ront"), QStringLiteral("view-front"), Qt::Key_1,
      tr("Look from the front, along Y"));
  add(StandardView::Right, "viewRight", tr("Ri&ght"), QStringLiteral("view-right"), Qt::Key_2,
      tr("Look from the right, along X"));
  add(StandardView::Top, "viewTop", tr("&Top"), QStringLiteral("view-top"), Qt::Key_3,
      tr("Look from above, along Z"));
}

void ViewActions::setUpDrawing() {
  const auto add = [this](void (Viewport::*set)(bool), const char* name, const QString& text,
                          const QString& iconName, const QString& help) {
    QAction* action = makeSwitch(this, name, text, iconName, true, help);
    connect(action, &QAction::toggled, &view_, set);
    switches_ << action;
  };
  add(&Viewport::setSeeThrough, "seeThrough", tr("&See through fixed parts"), QStringLiteral("translucent"),
      tr("Make the other parts translucent, to see the moving part through them"));
  add(&Viewport::setEdgesVisible, "edges", tr("&Edges"), QStringLiteral("edges"),
      tr("Draw the sharp edges of parts as lines"));
  add(&Viewport::setMinimaVisible, "minima", tr("&Minima"), QStringLiteral("minima"),
      tr("Draw each local minimum distance while a part is in hand"));
  add(&Viewport::setContactsVisible, "contacts", tr("C&ontacts"), QStringLiteral("contacts"),
      tr("Mark where the part in hand touches"));
  add(&Viewport::setHandVisible, "handGhost", tr("&Hand ahead of the part"), QStringLiteral("ghost"),
      tr("Draw where the hand wants a part that is held by contact"));
  add(&Viewport::setWrenchVisible, "wrench", tr("Force and torque &arrows"), QStringLiteral("wrench-arrows"),
      tr("Draw the felt force and torque as arrows"));
  view_.setSeeThrough(true);
  view_.setMinimaChoice(minima_->choice());
  connect(minima_, &MinimaMenu::choiceChanged, &view_, &Viewport::setMinimaChoice);
}

QMenu* ViewActions::minimaMenu() const noexcept {
  return minima_;
}

void ViewActions::update() {
  const bool hasParts = !session_.scene().parts().empty();
  fit->setEnabled(hasParts);
  for (QAction* view : views_)
    view->setEnabled(hasParts);
  fitSelection->setEnabled(!selection_.isEmpty());
}

}  // namespace nearfit::ui
