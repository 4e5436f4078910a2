// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <steadyrest/chatter/online/detector.hpp>

namespace steadyrest::chatter::online {

using kernel::outcome::Reason;

namespace {

constexpr double kSteady = 0.003;   // relative spread of the speed that still counts as constant
constexpr double kGuardBins = 1.5;  // half width of what a line takes of the spectrum
constexpr double kWideBins = 8.0;   // tooth orders nearer than this leave no gap to look into
constexpr double kJump = 4.0;       // in the tooth orders' energy: the tool enters or leaves
constexpr double kAllJump = 2.5;    // in the whole signal's energy
constexpr double kSlowRev = 20.0;   // memory of the energy that a jump is measured against
constexpr double kWitnessShare = 0.25;
constexpr double kLearnRev = 1.5;  // until the filter knows a new cut
constexpr double kLasting = 0.7;   // of the window's line energy that the last revolution still has
constexpr double kLastingMoving = 0.3;
constexpr double kLongestHoldS = 2.0;
constexpr double kFloorRiseS = 0.5;
constexpr double kFloorFallS = 2.0;
constexpr double kHop = 1.0 / 8.0;  // of the window, between spectra
constexpr double kTurn = 2.0 * std::numbers::pi;

kernel::outcome::Refusal refuse(const char* what) {
  return {kernel::outcome::Kind::bad_input, {}, 0, what, "correct the detector's setup"};
}

}  // namespace

kernel::outcome::Result<Detector> Detector::make(const Config& config) {
  if (!(config.off_ratio >= 0.0 && config.on_ratio >= config.off_ratio &&
        config.sure_ratio >= config.on_ratio && config.sure_ratio <= 1.0 &&
        config.sure_ratio_moving >= config.on_ratio && config.sure_ratio_moving <= 1.0)) {
    return std::unexpected(refuse("energy ratios do not rise from off over on to sure, 0…1"));
  }
  if (!(config.line_ratio >= 10.0 && config.margin >= 1.0 && config.confirm >= 1 &&
        config.confirm_moving >= 1)) {
    return std::unexpected(refuse("line ratio below 10, margin or confirmations below 1"));
  }
  if (!(config.least_energy >= 0.0 && config.learn_s >= 0.0 && config.settle_rev >= 0.0)) {
    return std::unexpected(refuse("an energy or a time is negative"));
  }
  auto filter = OrderFilter::make({.sample_rate_hz = config.sample_rate_hz,
                                   .teeth = config.teeth,
                                   .tooth_harmonics = config.tooth_harmonics,
                                   .spindle_harmonics = config.spindle_harmonics,
                                   .moving_memory_rev = config.moving_memory_rev});
  if (!filter) {
    return std::unexpected(filter.error());
  }
  auto spectrum = LineSpectrum::make({.sample_rate_hz = config.sample_rate_hz,
                                      .window_s = config.window_s,
                                      .lowest_hz = config.lowest_hz});
  if (!spectrum) {
    return std::unexpected(spectrum.error());
  }
  return Detector(config, std::move(*filter), std::move(*spectrum));
}

Detector::Detector(const Config& config, OrderFilter filter, LineSpectrum spectrum)
    : config_(config), filter_(std::move(filter)), spectrum_(std::move(spectrum)) {}

const Detector::Output& Detector::update(const Input& input) noexcept {
  out_.fresh = false;
  if (!std::isfinite(input.value) || !std::isfinite(input.speed_rev_s) ||
      std::isinf(input.angle_rev)) {
    out_.reason = Reason::input_not_finite;
    return out_;
  }
  const double turn_share = input.speed_rev_s / config_.sample_rate_hz;
  if (!(turn_share > 0.0 && turn_share < 0.25)) {
    out_.reason = Reason::input_out_of_range;
    return out_;
  }
  follow_speed(input);
  const OrderFilter::Output forced =
      filter_.update(input.value, state_.angle_rev, input.speed_rev_s,
                     state_.speed_spread >= kSteady, state_.hold);
  out_.residual = forced.residual;
  revolution_ = spread_.update(input.value - forced.mean, state_.angle_rev);
  follow_energy(forced, input.value - forced.mean, turn_share);
  // What the filter has not learnt yet is no line.
  const double shown = state_.settled_rev > kLearnRev ? forced.residual : 0.0;
  const double tooth_hz = static_cast<double>(config_.teeth) * state_.mean_speed_rev_s;
  const bool gaps = tooth_hz > kWideBins * spectrum_.resolution_hz();
  const bool steady = state_.speed_spread < kSteady;
  const double guard_hz = gaps && steady ? kGuardBins * spectrum_.resolution_hz() : 0.0;
  if (const auto& lines = spectrum_.update(shown, tooth_hz, guard_hz); lines.fresh) {
    judge(lines);
  }
  return out_;
}

void Detector::follow_speed(const Input& input) noexcept {
  if (!state_.started) {
    state_.started = true;
    state_.mean_speed_rev_s = input.speed_rev_s;
    state_.angle_rev = std::isnan(input.angle_rev) ? 0.0 : input.angle_rev;
  } else if (std::isnan(input.angle_rev)) {
    state_.angle_rev += input.speed_rev_s / config_.sample_rate_hz;
  } else {
    state_.angle_rev = input.angle_rev;
  }
  const double keep = 2.0 / static_cast<double>(spectrum_.length());
  state_.mean_speed_rev_s += keep * (input.speed_rev_s - state_.mean_speed_rev_s);
  const double off = std::abs(input.speed_rev_s / state_.mean_speed_rev_s - 1.0);
  state_.speed_spread += keep * (off - state_.speed_spread);
}

void Detector::follow_energy(const OrderFilter::Output& forced, double moving,
                             double turn_share) noexcept {
  state_.forced_energy += turn_share * (forced.forced_energy - state_.forced_energy);
  state_.tooth_energy += turn_share * (forced.tooth_energy - state_.tooth_energy);
  const double slow = std::max(turn_share / kSlowRev, turn_share / (state_.seen_rev + turn_share));
  state_.seen_rev = std::min(state_.seen_rev + turn_share, kSlowRev);
  state_.slow_energy += slow * (forced.tooth_energy - state_.slow_energy);
  state_.residual_energy +=
      turn_share * (forced.residual * forced.residual - state_.residual_energy);
  state_.settled_rev += turn_share;
  state_.energy += turn_share * (moving * moving - state_.energy);
  const double before = std::max(state_.slow_all, config_.least_energy);
  state_.slow_all += slow * (moving * moving - state_.slow_all);
  const bool entered =
      state_.tooth_energy > kJump * std::max(state_.slow_energy, config_.least_energy) ||
      state_.energy > kAllJump * before;
  const double pause_rev = state_.opened ? kSlowRev : config_.settle_rev;
  const bool calm = !out_.chatter && !state_.hold && state_.suspects == 0;
  if (entered && calm && state_.settled_rev > pause_rev) {
    state_.opened = true;
    state_.seen_rev = 0.0;
    filter_.open();
    state_.settled_rev = 0.0;
    state_.judged_s = 0.0;
    state_.floor_energy = 0.0;
  }
}

bool Detector::witnessed(double line_energy, double order) const noexcept {
  if (!revolution_.known) {
    return true;
  }
  const double expected = line_energy * (1.0 - std::cos(kTurn * order));
  return revolution_.changed_energy >= kWitnessShare * expected;
}

Detector::Kind Detector::kind_of(double frequency_hz) const noexcept {
  const double tooth_hz = static_cast<double>(config_.teeth) * state_.mean_speed_rev_s;
  const double order = frequency_hz / tooth_hz;
  const double from_half_hz = std::abs(order - std::floor(order) - 0.5) * tooth_hz;
  return from_half_hz < 0.5 * spectrum_.resolution_hz() ? Kind::flip : Kind::hopf;
}

void Detector::judge(const LineSpectrum::Output& lines) noexcept {
  const double hop_s = kHop * static_cast<double>(spectrum_.length()) / config_.sample_rate_hz;
  const double all = lines.line_energy + state_.forced_energy;
  const bool steady = state_.speed_spread < kSteady;
  out_.fresh = true;
  out_.energy_ratio = all > 0.0 ? lines.line_energy / all : 0.0;
  out_.spread_ratio = revolution_.known && revolution_.energy > 0.0
                          ? revolution_.changed_energy / revolution_.energy
                          : 0.0;
  const bool cuts = all > config_.least_energy;
  const bool settled = state_.settled_rev > config_.settle_rev;
  state_.judged_s += settled ? hop_s : 0.0;
  const bool lasts =
      state_.residual_energy > (steady ? kLasting : kLastingMoving) * lines.line_energy;
  const bool line = cuts && settled && lasts && lines.peak_ratio > config_.line_ratio &&
                    witnessed(lines.line_energy, lines.frequency_hz / state_.mean_speed_rev_s);
  const bool grown =
      state_.judged_s > config_.learn_s && lines.line_energy > config_.margin * state_.floor_energy;
  const bool suspect =
      line && (out_.energy_ratio > (steady ? config_.sure_ratio : config_.sure_ratio_moving) ||
               (out_.energy_ratio > config_.on_ratio && grown));
  // Hopf chatter is no spindle order: once it is told, the runout may be learnt again, or what was
  // learnt of its beginning would stand for ever. For the same reason flip is held for a while
  // only.
  const bool suspicious = line && out_.energy_ratio > 0.5 * config_.on_ratio;
  state_.held_s = suspicious ? state_.held_s + hop_s : 0.0;
  state_.hold =
      suspicious && state_.held_s < kLongestHoldS && (!out_.chatter || out_.kind == Kind::flip);
  state_.suspects = suspect ? state_.suspects + 1 : state_.suspects - std::min(state_.suspects, 1U);
  if (settled && !suspect && !out_.chatter) {
    learn(lines.line_energy);
  }
  state_.quiet = out_.energy_ratio < config_.off_ratio || !line ? state_.quiet + 1 : 0;
  if (!out_.chatter && state_.suspects >= (steady ? config_.confirm : config_.confirm_moving)) {
    out_.chatter = true;
    state_.quiet = 0;
  } else if (out_.chatter && static_cast<double>(state_.quiet) * kHop >= 1.0) {
    out_.chatter = false;
    state_.judged_s = 0.0;
    state_.floor_energy = 0.0;
  }
  if (out_.chatter && line) {
    out_.frequency_hz = lines.frequency_hz;
    out_.kind = kind_of(lines.frequency_hz);
  } else if (!out_.chatter) {
    out_.frequency_hz = line ? lines.frequency_hz : 0.0;
    out_.kind = cuts && state_.forced_energy > lines.noise_energy ? Kind::forced : Kind::none;
  }
  out_.reason = out_.chatter ? Reason::chatter_detected
                : !cuts      ? Reason::not_cutting
                             : Reason::none;
}

void Detector::learn(double line_energy) noexcept {
  const double hop_s = kHop * static_cast<double>(spectrum_.length()) / config_.sample_rate_hz;
  const double memory_s = line_energy > state_.floor_energy ? kFloorRiseS : kFloorFallS;
  // The first judgements weigh as a mean.
  const double weight = std::max(hop_s / memory_s, hop_s / std::max(state_.judged_s, hop_s));
  state_.floor_energy += std::min(weight, 1.0) * (line_energy - state_.floor_energy);
}

void Detector::reset() noexcept {
  filter_.reset();
  spectrum_.reset();
  spread_.reset();
  revolution_ = {};
  state_ = {};
  out_ = {};
}

}  // namespace steadyrest::chatter::online
