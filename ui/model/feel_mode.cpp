#include "ui/model/feel_mode.h"

#include <QComboBox>
#include <QObject>

#include "core/scene/haptic_limits.h"

namespace nearfit::ui {
namespace {

QString titleOf(FeelMode mode) {
  switch (mode) {
    case FeelMode::LinearSprings:
      return QObject::tr("Springs, linear");
    case FeelMode::PrintedSprings:
      return QObject::tr("Springs, quadratic (paper formula)");
    case FeelMode::Proxy:
      break;
  }
  return QObject::tr("Proxy: stops at contact");
}

}  // namespace

FeelMode feelModeOf(const HapticSettings& settings) noexcept {
  if (settings.mode == HapticMode::Proxy) return FeelMode::Proxy;
  return settings.springs.law == SpringLaw::Linear ? FeelMode::LinearSprings : FeelMode::PrintedSprings;
}

HapticSettings withMode(const HapticSettings& settings, FeelMode mode) noexcept {
  HapticSettings next = settings;
  next.mode = mode == FeelMode::Proxy ? HapticMode::Proxy : HapticMode::Springs;
  if (mode == FeelMode::LinearSprings) next.springs = withLaw(settings.springs, SpringLaw::Linear);
  if (mode == FeelMode::PrintedSprings) next.springs = withLaw(settings.springs, SpringLaw::Printed);
  return next;
}

QString explanationOf(FeelMode mode) {
  switch (mode) {
    case FeelMode::LinearSprings:
      return QObject::tr(
          "The part is where the hand is. Each minimum pushes with stiffness × (cutoff − distance), most "
          "at contact. A hard push goes through.");
    case FeelMode::PrintedSprings:
      return QObject::tr(
          "Like linear springs, but each minimum pushes with stiffness × (cutoff − distance) × distance, "
          "as printed in the paper: zero at contact, most at half the cutoff.");
    case FeelMode::Proxy:
      break;
  }
  return QObject::tr(
      "The part stops at contact. It follows the hand as far as other parts allow, and slides along them; "
      "the hand is pulled towards it.");
}

void addModes(QComboBox& box) {
  for (const FeelMode mode : {FeelMode::Proxy, FeelMode::LinearSprings, FeelMode::PrintedSprings}) {
    box.addItem(titleOf(mode), QVariant::fromValue(mode));
    box.setItemData(box.count() - 1, explanationOf(mode), Qt::ToolTipRole);
  }
}

void showMode(QComboBox& box, FeelMode mode) {
  for (int i = 0; i < box.count(); ++i) {
    if (box.itemData(i).value<FeelMode>() == mode) box.setCurrentIndex(i);
  }
}

}  // namespace nearfit::ui
