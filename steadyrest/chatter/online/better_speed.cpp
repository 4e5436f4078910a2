// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <steadyrest/chatter/online/better_speed.hpp>

namespace steadyrest::chatter::online {
namespace {

constexpr double kSameSpeed = 0.01;

}  // namespace

kernel::outcome::Result<BetterSpeed> BetterSpeed::make(Config config) {
  if (!(config.again_s > 0.0)) {
    return std::unexpected(kernel::outcome::Refusal{kernel::outcome::Kind::bad_input,
                                                    {},
                                                    0,
                                                    "again_s is not above 0",
                                                    "correct the detector's setup"});
  }
  auto detector = Detector::make(config.detector);
  if (!detector) {
    return std::unexpected(detector.error());
  }
  auto table = SpeedTable::make(std::move(config.table));
  if (!table) {
    return std::unexpected(table.error());
  }
  return BetterSpeed(config.again_s * config.detector.sample_rate_hz, std::move(*detector),
                     std::move(*table));
}

BetterSpeed::BetterSpeed(double again_samples, Detector detector, SpeedTable table)
    : again_samples_(again_samples), detector_(std::move(detector)), table_(std::move(table)) {}

const BetterSpeed::Output& BetterSpeed::update(const Input& input) noexcept {
  const bool other_cut =
      std::abs(input.programmed_rev_s - programmed_rev_s_) > kSameSpeed * programmed_rev_s_;
  if (std::isfinite(input.programmed_rev_s) && other_cut) {
    programmed_rev_s_ = input.programmed_rev_s;
    out_.request = {};
    answer_ = kernel::outcome::Reason::none;
  }
  const bool before = out_.chatter;
  const auto& heard = detector_.update(
      {.value = input.value, .speed_rev_s = input.speed_rev_s, .angle_rev = input.angle_rev});
  out_.chatter = heard.chatter;
  out_.kind = heard.kind;
  out_.frequency_hz = heard.frequency_hz;
  since_asked_ += 1.0;
  if (out_.chatter && (!before || since_asked_ >= again_samples_)) {
    ask(input);
  }
  const bool answered = answer_ != kernel::outcome::Reason::none;
  out_.reason = answered ? answer_ : heard.reason;
  return out_;
}

void BetterSpeed::ask(const Input& input) noexcept {
  since_asked_ = 0.0;
  const SpeedTable::Advice advice = table_.ask({.programmed_rev_s = input.programmed_rev_s,
                                                .ratio = input.ratio,
                                                .depth_mm = input.depth_mm,
                                                .frequency_hz = out_.frequency_hz});
  answer_ = advice.reason;
  if (advice.speed_rev_s > 0.0) {
    out_.request = advice.request;
  }
}

void BetterSpeed::reset() noexcept {
  detector_.reset();
  programmed_rev_s_ = since_asked_ = 0.0;
  answer_ = kernel::outcome::Reason::none;
  out_ = {};
}

}  // namespace steadyrest::chatter::online
