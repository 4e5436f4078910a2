// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <steadyrest/chatter/online/better_speed.hpp>
#include <steadyrest/chatter/online/orders/detector_refusal.hpp>

namespace steadyrest::chatter::online {
namespace {

constexpr double kFallen = 0.7;  // of the lines' energy
constexpr double kPause = 10.0;
constexpr double kSameSpeed = 0.01;  // rounding of S words; override steps are 5 % apart

}  // namespace

kernel::outcome::Result<BetterSpeed> BetterSpeed::make(Config config) {
  if (!(config.again_s > 0.0)) {
    return refuse_detector("again_s is not above 0");
  }
  auto detector = Detector::make(config.detector);
  if (!detector) {
    return std::unexpected(detector.error());
  }
  auto table = SpeedTable::make(std::move(config.table));
  if (!table) {
    return std::unexpected(table.error());
  }
  return BetterSpeed(std::move(config), std::move(*detector), std::move(*table));
}

BetterSpeed::BetterSpeed(Config config, Detector detector, SpeedTable table)
    : again_samples_(config.again_s * config.detector.sample_rate_hz),
      threshold_(config.detector.sure_ratio),
      modes_hz_(std::move(config.modes_hz)),
      table_(std::move(table)),
      state_{.detector = std::move(detector), .confidence = {}, .out = {}} {}

const BetterSpeed::Output& BetterSpeed::update(const Input& input) noexcept {
  // Another programmed speed is another cut: the advice for the last one is dropped.
  const bool other_cut = std::abs(input.programmed_rev_s - state_.programmed_rev_s) >
                         kSameSpeed * state_.programmed_rev_s;
  if (std::isfinite(input.programmed_rev_s) && other_cut) {
    state_.programmed_rev_s = input.programmed_rev_s;
    state_.out.request = {};
    state_.answer = kernel::outcome::Reason::none;
    state_.gave_up = false;
  }
  const bool before = state_.out.chatter;
  const auto& heard = state_.detector.update(
      {.value = input.value, .speed_rev_s = input.speed_rev_s, .angle_rev = input.angle_rev});
  state_.out.chatter = heard.chatter;
  state_.out.kind = heard.kind;
  state_.out.frequency_hz = heard.frequency_hz;
  state_.out.level = heard.energy_ratio;
  state_.out.threshold = threshold_;
  if (heard.fresh) {
    show(heard);
  }
  state_.since_asked += 1.0;
  // At once when chatter begins, then at intervals: the frequency moves with the speed, and another
  // step may help where the first did not.
  state_.gave_up = state_.gave_up && state_.since_asked < kPause * again_samples_;
  if (state_.out.chatter && !state_.gave_up && (!before || state_.since_asked >= again_samples_)) {
    ask(input, heard.line_energy);
  }
  const bool answered = state_.answer != kernel::outcome::Reason::none;
  state_.out.reason = answered ? state_.answer : heard.reason;
  return state_.out;
}

/// What a spectrum has shown beside the verdict.
void BetterSpeed::show(const Detector::Output& heard) noexcept {
  if (heard.chatter) {
    state_.confidence.add(heard);
  } else {
    state_.confidence.reset();
  }
  Output& out = state_.out;
  const bool known = shows_speed(heard);
  // As the chatter ends another line may be the strongest for a moment.
  const double off_hz = std::abs(heard.line.frequency_hz - heard.frequency_hz);
  if (!heard.chatter || off_hz < state_.detector.resolution_hz()) {
    out.line = heard.line;
    out.mode_hz = nearest_mode_hz(modes_hz_, heard.line.frequency_hz);
  }
  out.confidence = state_.confidence.value();
  out.speed_rev_s = known ? heard.speed_rev_s : 0.0;
  out.speed_sd = known ? heard.speed_sd : 0.0;
  out.clips = state_.detector.clips();
}

void BetterSpeed::ask(const Input& input, double line_energy) noexcept {
  state_.since_asked = 0.0;
  const SpeedTable::Advice advice = table_.ask({.programmed_rev_s = input.programmed_rev_s,
                                                .ratio = input.ratio,
                                                .depth_mm = input.depth_mm,
                                                .frequency_hz = state_.out.frequency_hz});
  state_.answer = advice.reason;
  if (advice.speed_rev_s > 0.0) {
    state_.out.request = advice.request;
    state_.line_energy = line_energy;
  } else if (line_energy > kFallen * state_.line_energy) {
    // Both speeds chatter, so the operator's own is as good. A step that has taken something away
    // stays.
    state_.gave_up = state_.out.request.ratio != 1.0;
    state_.out.request = {};
  }
}

void BetterSpeed::reset() noexcept {
  state_.detector.reset();
  state_.programmed_rev_s = state_.since_asked = state_.line_energy = 0.0;
  state_.answer = kernel::outcome::Reason::none;
  state_.gave_up = false;
  state_.confidence.reset();
  state_.out = {};
}

}  // namespace steadyrest::chatter::online
