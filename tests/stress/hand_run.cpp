#include "tests/stress/hand_run.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/haptics/wrench_conditioner.h"
#include "device/servo/servo_loop.h"
#include "tests/bench/portable_random.h"
#include "tests/stress/hand_motion.h"
#include "tests/stress/held_hand.h"
#include "tests/stress/pose_checks.h"
#include "tests/stress/stress_servo.h"

namespace nearfit::stress {
namespace {

/// Ticks between changes of settings.
constexpr std::uint64_t kEpisode = 800;
/// What a wrench takes at most to be whole again [s].
constexpr double kRise = std::max(WrenchConditioner::kRampTime, WrenchConditioner::kRecoveryTime);

/// What holds for an episode.
struct Episode {
  bool isHeld = false;        ///< By a grip with mass; else led.
  double jitter = 0.0;        ///< Periods are longer by up to so many.
  bool isStuttering = false;  ///< Input gets old now and then.
  bool usesClutch = false;
};

class HandRun {
 public:
  HandRun(const StressScene& scene, const HandRunOptions& options)
      : scene_(scene),
        options_(options),
        random_(options.seed),
        motion_(scene, options.seed + 1),
        servo_(scene.scene, parametersOf(scene, options.mode), options.seed + 2),
        hand_({}, scene.scene->centreInPart, scene.scene->moving.worldFromPart),
        poses_(scene) {}

  HandRunResult run() {
    if (isProxy()) poses_.add(scene_.scene->moving.worldFromPart, 0);
    for (; result_.ticks < options_.ticks && !result_.failure; ++result_.ticks) {
      if (result_.ticks % kEpisode == 0) beginEpisode();
      tick();
      if (poses_.firstBad()) break;
    }
    result_.certified = poses_.certified();
    result_.meetings = poses_.meetings();
    result_.energyGain = std::max(largestGain_, ledger_.largestGain());
    const double most = isProxy() ? kMaxEnergyGain : kMaxSpringEnergyGain;
    if (!result_.failure && scene_.isEnergyBound && result_.energyGain > most)
      result_.failure = fmt::format("the hand gained {:.3g} J", result_.energyGain);
    if (!result_.failure && result_.ledgerError > kMaxLedgerError)
      result_.failure = fmt::format("the servo's account of energy is off by {:.3g}", result_.ledgerError);
    if (poses_.firstBad()) noteBadPose();
    return result_;
  }

 private:
  bool isProxy() const { return options_.mode == StressMode::Proxy; }

  static ServoParameters parametersOf(const StressScene& scene, StressMode mode) {
    ServoParameters parameters;
    parameters.haptics.proxy.margin = scene.margin;
    parameters.haptics.springs.cutoff = scene.cutoff;
    setMode(parameters.haptics, mode, SpringParameters{}.stiffness);
    return parameters;
  }

  bool chance(double probability) { return bench::uniform(random_) < probability; }
  double within(double low, double high) { return low * std::pow(high / low, bench::uniform(random_)); }

  void beginEpisode() {
    episode_ = {chance(0.4), chance(0.5) ? 0.0 : 3.0, chance(0.2), chance(0.1)};
    HapticSettings& settings = servo_.parameters().haptics;
    settings.proxy.friction = chance(0.6) ? 0.0 : bench::uniform(random_);
    settings.proxy.margin = scene_.margin * (chance(0.7) ? 1.0 : within(0.5, 2.0));
    settings.weight.hasWeight = chance(0.2);
    settings.weight.hasInertia = chance(0.2);
    settings.coupling.isAutomatic = chance(0.5);
    settings.coupling.stiffness = within(1.0, 1e5);
    settings.coupling.damping = chance(0.5) ? 0.0 : bench::uniform(random_);
    settings.coupling.rotationalStiffness = within(1e-3, 10.0);
    if (!isProxy()) {
      // To beyond what a device bears; the proxy's settings are drawn above all the same.
      setMode(settings, options_.mode, within(10.0, 1e5));
      settings.springs.damping = chance(0.5) ? 0.0 : bench::uniform(random_);
    }
    servo_.setArrival(static_cast<Arrival>(random_() % 3));
    // From where it is narrow, as often as not: a hand this wild seldom finds its way back.
    if (chance(0.5)) startAnew();
    if (episode_.isHeld) hand_ = HeldHand({}, scene_.scene->centreInPart, servo_.snapshot().handle);
    ledger_.cut();
  }

  void startAnew() {
    servo_.reset();
    isFirst_ = true;
    largestGain_ = std::max(largestGain_, ledger_.largestGain());
    ledger_ = {};
    turnover_ = 0.0;
    whole_ = 0.0;
  }

  double nextPeriod() { return ServoLoop::kPeriod * (1.0 + episode_.jitter * bench::uniform(random_)); }

  void tick() {
    const double period = nextPeriod();
    *before_ = servo_.snapshot();
    RigidTransform wanted = motion_.next(before_->proxy, period);
    if (isFirst_) {
      wanted = scene_.scene->moving.worldFromPart;
      hand_ = HeldHand({}, scene_.scene->centreInPart, wanted);
    }
    if (episode_.isHeld && !isFirst_) {
      hand_.step(wanted, before_->wrench, period);
      wanted = hand_.pose();
    }
    HandleInput input{.pose = wanted};
    if (episode_.isStuttering && chance(0.3)) input.age = 0.06 * bench::uniform(random_);
    input.isClutched = episode_.usesClutch && (result_.ticks / 100) % 3 == 0;
    check(servo_.tick(input, period), period);
  }

  void check(const ServoSnapshot& now, double period) {
    result_.extremes.add(now);
    const ServoParameters& parameters = servo_.parameters();
    if (isFirst_) *before_ = now;
    if (const auto fault = faultOf(now, *before_, parameters, period)) {
      result_.failure = fmt::format("tick {} ({}): {}", result_.ticks, nameOf(motion_.kind()), *fault);
      return;
    }
    if (!isFirst_) {
      result_.extremes.addStep(*scene_.scene, *before_, now);
      // A ramp (after a clutch too) and a wrench that has faded with its input give what was stretched
      // meanwhile its force.
      if (episode_.isStuttering || episode_.usesClutch) whole_ = 0.0;
      if (!episode_.isHeld || whole_ <= kRise) ledger_.cut();
      whole_ += period;
      ledger_.add(*scene_.scene, parameters, *before_, now, period);
      turnover_ += std::abs(now.energyToHand - before_->energyToHand);
      const double error = std::abs(ledger_.energyToHand() - now.energyToHand) / std::max(turnover_, 1e-9);
      result_.ledgerError = std::max(result_.ledgerError, error);
    }
    isFirst_ = false;
    if (isProxy() && options_.certifyEvery > 0 && result_.ticks % options_.certifyEvery == 0)
      poses_.add(now.proxy, result_.ticks);
  }

  void noteBadPose() {
    const RigidTransform& p = poses_.firstBadPose();
    result_.failure = fmt::format(
        "tick {}: the part meets the scene or has changed sides at ({:.17g} {:.17g} {:.17g}) turned "
        "({:.17g} {:.17g} {:.17g} {:.17g})",
        *poses_.firstBad(), p.translation.x, p.translation.y, p.translation.z, p.rotation.w, p.rotation.x,
        p.rotation.y, p.rotation.z);
  }

  const StressScene& scene_;
  const HandRunOptions options_;
  std::mt19937_64 random_;
  HandMotion motion_;
  StressServo servo_;
  HeldHand hand_;
  PoseChecks poses_;
  EnergyLedger ledger_;
  Episode episode_;
  std::unique_ptr<ServoSnapshot> before_ = std::make_unique<ServoSnapshot>();
  double turnover_ = 0.0, largestGain_ = 0.0;
  double whole_ = 0.0;   ///< Since the servo started, was clutched, or had old input [s].
  bool isFirst_ = true;  ///< Tick of a servo that has just been started.
  HandRunResult result_;
};

}  // namespace

HandRunResult runHand(const StressScene& scene, const HandRunOptions& options) {
  return HandRun(scene, options).run();
}

}  // namespace nearfit::stress
