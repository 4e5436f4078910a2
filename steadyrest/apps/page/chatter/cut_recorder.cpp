// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/apps/page/chatter/cut_recorder.hpp>
#include <steadyrest/apps/page/shared/json_numbers.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/kernel/units/convert.hpp>

// Fits a cut of hours into a page of a megabyte: extremes per stretch for the long view, one point
// per revolution for the Poincaré view, the last turns in full for the shape.
namespace steadyrest::apps::page {
namespace {

using kernel::units::kTurn;
using trial::vibration::Moment;

constexpr double kUm = 1000.0;
/// As many stretches as a wide screen has pixels.
constexpr double kEnvelopeStretches = 3000.0;
constexpr double kWhole = 1e-6;  ///< short of a whole number counts as one
constexpr double kMostTurns = 4000.0;
constexpr double kLastTurns = 6.0;
constexpr std::size_t kMostLast = 8000;

Json columns_of(const CutRecorder::Envelope& e) {
  return {{"t_s", short_numbers(e.t_s)},
          {"x_low_um", short_numbers(e.low[0])},
          {"x_high_um", short_numbers(e.high[0])},
          {"y_low_um", short_numbers(e.low[1])},
          {"y_high_um", short_numbers(e.high[1])},
          {"force_low_N", short_numbers(e.low[2])},
          {"force_high_N", short_numbers(e.high[2])}};
}

/// The last turns in columns, one array per quantity.
Json columns_of(const std::vector<Moment>& moments) {
  const auto column = [&moments](auto value) {
    std::vector<double> out;
    out.reserve(moments.size());
    for (const Moment& m : moments) {
      out.push_back(value(m));
    }
    return short_numbers(out);
  };
  return {{"t_s", column([](const Moment& m) { return m.t_s; })},
          {"turn", column([](const Moment& m) { return m.angle_rad / kTurn; })},
          {"speed_rpm",
           column([](const Moment& m) { return kernel::units::rpm_from_rev_s(m.speed_rev_s); })},
          {"x_um", column([](const Moment& m) { return kUm * m.cut.displacement_mm[0]; })},
          {"y_um", column([](const Moment& m) { return kUm * m.cut.displacement_mm[1]; })},
          {"fx_N", column([](const Moment& m) { return m.cut.force_n[0]; })},
          {"fy_N", column([](const Moment& m) { return m.cut.force_n[1]; })},
          {"chip_um", column([](const Moment& m) { return kUm * m.cut.chip_mm; })}};
}

}  // namespace

/// The last stretch takes the rest of the time, and rounding must not open another one.
CutRecorder::CutRecorder(double seconds, double mean_rev_s)
    : stretch_s_(seconds / kEnvelopeStretches),
      last_stretch_(std::max(0.0, std::floor(seconds / stretch_s_ + kWhole) - 1.0)),
      // Every nth turn, so that the points stay below 4000.
      stride_(
          static_cast<std::size_t>(std::max(1.0, std::ceil(seconds * mean_rev_s / kMostTurns)))) {}

void CutRecorder::add(const Moment& now) {
  widen(now);
  if (!last_.empty()) {
    turn(now);
  }
  last_.push_back(now);
  while (last_.size() > kMostLast || now.angle_rad - last_.front().angle_rad > kLastTurns * kTurn) {
    last_.pop_front();
  }
}

/// Extremes, not means: a mean over a vibration is 0.
void CutRecorder::widen(const Moment& now) {
  const std::array value{kUm * now.cut.displacement_mm[0], kUm * now.cut.displacement_mm[1],
                         std::hypot(now.cut.force_n[0], now.cut.force_n[1])};
  const double stretch = std::min(std::floor(now.t_s / stretch_s_), last_stretch_);
  const bool fresh = stretch > stretch_;
  stretch_ = std::max(stretch, stretch_);
  if (fresh) {
    envelope_.t_s.push_back(now.t_s);
  }
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (fresh) {
      envelope_.low[i].push_back(value[i]);
      envelope_.high[i].push_back(value[i]);
    }
    double& low = envelope_.low[i].back();
    double& high = envelope_.high[i].back();
    low = std::min(low, value[i]);
    high = std::max(high, value[i]);
  }
}

/// Once a revolution, at the angle 0: a stable cut shows one point (it repeats), Hopf chatter a
/// closed curve, flip chatter two points (one with an even number of teeth, where it repeats with
/// the revolution).
void CutRecorder::turn(const Moment& now) {
  const Moment& before = last_.back();
  const double whole = std::floor(now.angle_rad / kTurn);
  if (!(whole > turned_)) {
    return;
  }
  turned_ = whole;
  if (std::fmod(whole, static_cast<double>(stride_)) != 0.0) {
    return;
  }
  // The crossing lies between two steps; linear interpolation finds it.
  const double share = (whole * kTurn - before.angle_rad) / (now.angle_rad - before.angle_rad);
  turns_.t_s.push_back(std::lerp(before.t_s, now.t_s, share));
  for (std::size_t axis = 0; axis < 2; ++axis) {
    turns_.place_um[axis].push_back(
        kUm * std::lerp(before.cut.displacement_mm[axis], now.cut.displacement_mm[axis], share));
  }
}

std::vector<Moment> CutRecorder::last() const {
  return {last_.begin(), last_.end()};
}

Json simulate_page(const Json& answer, const chatter::offline::Process& process,
                   const CutRecorder& cut) {
  Json page = chatter_head("simulate", process.name, answer);
  page["teeth"] = process.tool.teeth;
  page["operation"] =
      process.cut.operation == chatter::offline::Operation::turning ? "turning" : "milling";
  page["envelope"] = columns_of(cut.envelope());
  page["last"] = columns_of(cut.last());
  page["turns"] = {{"between", cut.turns_between()},
                   {"t_s", short_numbers(cut.turns().t_s)},
                   {"x_um", short_numbers(cut.turns().place_um[0])},
                   {"y_um", short_numbers(cut.turns().place_um[1])}};
  return page;
}

}  // namespace steadyrest::apps::page
