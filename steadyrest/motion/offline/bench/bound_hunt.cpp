// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/motion/offline/bench/bound_hunt.hpp>
#include <steadyrest/motion/offline/scene/scene.hpp>
#include <steadyrest/motion/offline/scene/score.hpp>
#include <steadyrest/motion/online/bounded/motion_estimator.hpp>

// Searches for a counterexample with random motions, encoders, clocks and losses, each within the
// limits given to the estimator: a single value outside its bound is a bug. A seed reproduces any
// finding.
namespace steadyrest::motion::offline {
namespace {

using online::MotionEstimator;

class Dice {
 public:
  explicit Dice(std::uint64_t seed)
      : random_(seed * 6364136223846793005ULL + 1442695040888963407ULL) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  /// Even in the logarithm.
  /// Counts, speeds and clocks differ by powers of ten; drawn evenly, small ones would hardly
  /// occur.
  double about(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  bool chance(double share) { return between(0.0, 1.0) < share; }

 private:
  std::mt19937_64 random_;
};

// Real axes start and stop: the hardest motions for a bound are where the jerk changes sign.
Profile stops_and_goes(Dice& dice) {
  const double acceleration = dice.about(20.0, 5000.0);
  const double jerk = dice.about(200.0, 100000.0);
  const double speed = dice.about(0.05, 300.0);
  std::vector<JerkPiece> pieces{{dice.between(0.0, 0.05), 0.0}};
  double sign = 1.0;
  for (int i = 0; i < 6; ++i) {
    const double v = sign * speed * dice.between(0.05, 1.0);
    const double used = jerk * dice.between(0.3, 1.0);
    for (const double change : {v, -v}) {
      const auto ramp = speed_change(change, acceleration, used);
      pieces.insert(pieces.end(), ramp.begin(), ramp.end());
      pieces.push_back({dice.about(0.001, 0.2), 0.0});
    }
    sign = dice.chance(0.7) ? -sign : sign;
  }
  return jerk_pieces("stops and goes", {dice.between(-0.01, 0.01), 0.0, 0.0}, pieces);
}

Profile any_profile(Dice& dice) {
  if (dice.chance(0.6)) {
    return stops_and_goes(dice);
  }
  const double frequency = dice.about(0.2, 40.0);
  return dice.chance(0.5) ? sine(dice.about(0.0005, 2.0), frequency, 1.0)
                          : dither(dice.about(0.0002, 0.02), frequency, 1.0);
}

Recording any_recording(Dice& dice, std::uint64_t seed) {
  Recording how;
  how.count_mm = dice.about(0.0002, 0.01);
  how.cycle_hz = dice.chance(0.5) ? 1000.0 : dice.about(250.0, 4000.0);
  how.clock_s = dice.chance(0.2) ? 0.0 : dice.about(1e-8, 1e-5);
  how.phase_error_counts = dice.chance(0.5) ? 0.0 : dice.between(0.0, 0.1);
  how.line_error_counts = dice.chance(0.5) ? 0.0 : dice.between(0.0, 0.03);
  how.tick_jitter_s = dice.chance(0.5) ? 0.0 : dice.between(0.0, 0.1) / how.cycle_hz;
  how.lost_share = dice.chance(0.8) ? 0.0 : dice.between(0.0, 0.05);
  how.seed = seed;
  return how;
}

double worst(const std::vector<double>& errors) {
  double out = 0.0;
  for (const double e : errors) {
    out = std::max(out, std::abs(e));
  }
  return out;
}

}  // namespace

// Seeds go up one by one until enough ticks have been checked.
Hunt hunt_bounds(std::uint64_t seed, std::uint64_t ticks) {
  Hunt out;
  for (; out.ticks < ticks; ++seed) {
    Dice dice(seed);
    const Profile profile = any_profile(dice);
    Record record = offline::record(profile, any_recording(dice, seed));
    // Only a real counter loses counts for good; here the count is true and stamps are missing.
    const double line_error = worst(record.line_error_mm);
    if (line_error > 0.0) {  // the ticks' cells have no table: their borders have the lines' errors
      for (online::Tick& tick : record.ticks) {
        tick.low_mm -= line_error;
        tick.high_mm += line_error;
      }
    }
    // Only counts: the other branch of the bound.
    if (dice.chance(0.15)) {
      record = without_edges(record);
    }
    MotionEstimator::Config config;
    config.count_mm = record.how.count_mm;
    config.cycle_s = 1.0 / record.how.cycle_hz;
    config.clock_s = record.how.clock_s;
    config.line_error_mm = line_error;
    // The profile's own figures are sampled at instants: add a little.
    config.max_speed_mm_s = record.max_speed_mm_s * 1.0001 + 1e-9;
    config.max_acceleration_mm_s2 = record.max_acceleration_mm_s2 * 1.0001 + 1e-9;
    config.max_jerk_mm_s3 = record.max_jerk_mm_s3 * 1.0001 + 1e-9;
    config.lag_s = dice.chance(0.7) ? 0.0 : std::floor(dice.between(1.0, 16.0)) * config.cycle_s;
    auto estimator = MotionEstimator::make(config);
    if (!estimator) {
      out.first = fmt::format("seed {}: {}", seed, estimator.error().what);
      return out;
    }
    const auto estimates = run(*estimator, record);
    for (const online::Estimate& e : estimates) {
      const MotionState truth = profile.at(e.t_s);
      // Rounding of the comparison, not of the bound.
      const bool v = std::abs(truth.velocity_mm_s - e.velocity_mm_s) > e.velocity_bound_mm_s + 1e-9;
      const bool a = std::abs(truth.acceleration_mm_s2 - e.acceleration_mm_s2) >
                     e.acceleration_bound_mm_s2 + 1e-6;
      const bool x = std::abs(truth.position_mm - e.position_mm) > e.position_bound_mm + 1e-9;
      out.velocity_outside += v ? 1U : 0U;
      out.acceleration_outside += a ? 1U : 0U;
      out.position_outside += x ? 1U : 0U;
      if ((v || a || x) && out.first.empty()) {
        out.first = fmt::format(
            "seed {} ({}), t {:.6f} s: v {:.6f} estimate {:.6f} ± {:.6f}, a {:.4f} estimate {:.4f} "
            "± {:.4f}, x {:.6f} estimate {:.6f} ± {:.6f}",
            seed, profile.name, e.t_s, truth.velocity_mm_s, e.velocity_mm_s, e.velocity_bound_mm_s,
            truth.acceleration_mm_s2, e.acceleration_mm_s2, e.acceleration_bound_mm_s2,
            truth.position_mm, e.position_mm, e.position_bound_mm);
      }
    }
    out.contradictions += estimator->contradictions();
    out.ticks += estimates.size();
    ++out.records;
  }
  return out;
}

}  // namespace steadyrest::motion::offline
