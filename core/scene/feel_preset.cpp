#include "core/scene/feel_preset.h"

#include "core/base/error.h"
#include "core/scene/haptic_limits.h"
#include "core/scene/names.h"

namespace nearfit {
namespace {

FeelPreset usual(const char* name, double stiffness, const CouplingSettings& coupling) {
  FeelPreset preset;
  preset.name = name;
  preset.isOfStiffnessAlone = true;
  preset.settings.springs.stiffness = stiffness;
  preset.settings.coupling = coupling;
  return preset;
}

}  // namespace

const std::array<FeelPreset, 3>& usualFeelPresets() {
  // About a fifth and a half of what the default device allows. The damping steadies a loosely held part.
  static const std::array<FeelPreset, 3> presets = {usual("Soft", 40.0,
                                                          {.isAutomatic = false,
                                                           .stiffness = 250.0,
                                                           .damping = 0.1,
                                                           .rotationalStiffness = 0.25,
                                                           .rotationalDamping = 1e-4}),
                                                    usual("Medium", 100.0,
                                                          {.isAutomatic = false,
                                                           .stiffness = 600.0,
                                                           .damping = 0.1,
                                                           .rotationalStiffness = 0.6,
                                                           .rotationalDamping = 1e-4}),
                                                    usual("Stiff", SpringParameters{}.stiffness, {})};
  return presets;
}

HapticSettings withPreset(const HapticSettings& settings, const FeelPreset& preset) noexcept {
  HapticSettings next = settings;
  // Unused numbers do not affect the feel.
  next.coupling.isAutomatic = preset.settings.coupling.isAutomatic;
  if (!next.coupling.isAutomatic) next.coupling = preset.settings.coupling;
  next.springs = preset.settings.springs;
  next.springs.cutoff = settings.springs.cutoff;
  if (preset.isOfStiffnessAlone) {
    next.springs = withLaw(next.springs, settings.springs.law);
    next.springs.onePerArea = settings.springs.onePerArea;
    return next;
  }
  next.mode = preset.settings.mode;
  next.proxy.friction = preset.settings.proxy.friction;
  next.weight.hasWeight = preset.settings.weight.hasWeight;
  next.weight.hasInertia = preset.settings.weight.hasInertia;
  return next;
}

bool isInForce(const FeelPreset& preset, const HapticSettings& settings) noexcept {
  HapticSettings made = withPreset(settings, preset);
  if (made.mode == HapticMode::Proxy) {
    made.springs = settings.springs;
  } else {
    made.coupling = settings.coupling;
    made.proxy = settings.proxy;
    made.weight.hasInertia = settings.weight.hasInertia;
  }
  return made == settings;
}

void checkFeelPreset(const FeelPreset& preset) {
  checkName("preset", preset.name, kMaxFeelPresetNameBytes);
  checkHaptics(preset.settings);
}

}  // namespace nearfit
