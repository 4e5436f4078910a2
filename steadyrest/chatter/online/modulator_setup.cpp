// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <steadyrest/chatter/online/modulator.hpp>
#include <steadyrest/chatter/online/modulator_range.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// What the modulator computes once from its settings.
namespace steadyrest::chatter::online {
namespace {

namespace machine = kernel::machine;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::override::kRatioTolerance;

struct Range {
  const char* name;
  double value;
  double min;
  double max;
};

Result<void> check(const Modulator::Config& c) {
  constexpr double kMost = 1e9;
  if (!fit(c.modulation)) {
    return refuse("the law, amplitude, period or mean of the modulation is out of range",
                  "correct law, amplitude, period_s and mean_percent of [chatter]");
  }
  for (const Range& r :
       {Range{"min_ratio", c.min_ratio, 1e-3, 10.0},
        Range{"max_ratio", c.max_ratio, c.min_ratio, 10.0},
        Range{"min_rev_s", c.min_rev_s, 0.0, kMost},
        Range{"max_rev_s", std::min(c.max_rev_s, kMost), c.min_rev_s, kMost},
        Range{"acceleration_rev_s2", std::min(c.acceleration_rev_s2, kMost), 1e-6, kMost},
        Range{"min_feed_per_tooth_ratio", c.min_feed_per_tooth_ratio, 1e-3, 1.0},
        Range{"max_feed_per_tooth_ratio", c.max_feed_per_tooth_ratio, 1.0, 100.0},
        Range{"min_feed_ratio", c.min_feed_ratio, 0.0, 1.0},
        Range{"max_feed_ratio", c.max_feed_ratio, 1e-3, 10.0}, Range{"fade_s", c.fade_s, 1e-3, 1e3},
        Range{"hysteresis", c.hysteresis, 0.0, 0.5},
        Range{"max_step_s", c.max_step_s, 1e-6, 1e3}}) {
    if (!(r.value >= r.min && r.value <= r.max)) {
      return refuse(
          fmt::format("modulator: {} = {:g} is outside {:g} … {:g}", r.name, r.value, r.min, r.max),
          "correct [chatter] or [envelope]");
    }
  }
  return {};
}

/// A word written just after a scan waits a whole period for the next one, then acts a dead time
/// later.
double delay_s(const machine::OverrideTable& table) noexcept {
  return table.scan_period_s + table.dead_time_s;
}

}  // namespace

Result<Modulator> Modulator::make(const Config& config) {
  if (auto ok = check(config); !ok) {
    return std::unexpected(ok.error());
  }
  auto spindle = Table::make(config.spindle_table);
  if (!spindle) {
    return std::unexpected(spindle.error());
  }
  // At least two steps, or every law is a constant.
  const auto lowest = spindle->ceil_step(config.min_ratio);
  const auto highest = spindle->floor_step(config.max_ratio);
  if (!lowest || !highest ||
      spindle->ratio(*highest) <= spindle->ratio(*lowest) + kRatioTolerance) {
    return refuse(
        fmt::format("the spindle override has fewer than two steps within {:g} … {:g} %: "
                    "there is nothing to modulate with",
                    100.0 * config.min_ratio, 100.0 * config.max_ratio),
        "give [override.spindle] and an [envelope] that contains some of its steps, or set "
        "enabled = false in [chatter]");
  }
  std::optional<Table> feed;
  if (!config.feed_table.ratio.empty()) {
    auto made = Table::make(config.feed_table);
    if (!made) {
      return std::unexpected(made.error());
    }
    feed = std::move(*made);
  }
  return Modulator(config, std::move(*spindle), std::move(feed));
}

Result<Modulator> Modulator::make(const machine::Machine& m) {
  const machine::Chatter& c = m.chatter;
  return make(Config{
      .modulation = {.law = c.law,
                     .amplitude_ratio = c.amplitude_ratio,
                     .amplitude_rev_s = c.amplitude_rev_s,
                     .period_s = c.period_s,
                     .mean_ratio = c.mean_ratio,
                     .seed = c.seed},
      .spindle_table = m.spindle_override,
      .feed_table = m.feed_override,
      .min_ratio = std::max(m.envelope.min_spindle_ratio, 1e-3),
      .max_ratio = std::min(m.envelope.max_spindle_ratio, m.spindle_override.max_ratio),
      .min_rev_s = m.spindle.min_rev_s,
      .max_rev_s = m.spindle.max_rev_s,
      .acceleration_rev_s2 = m.spindle.acceleration_rev_s2,
      .min_feed_per_tooth_ratio = c.min_feed_per_tooth_ratio,
      .max_feed_per_tooth_ratio = c.max_feed_per_tooth_ratio,
      .min_feed_ratio = m.envelope.min_feed_ratio,
      .max_feed_ratio = m.envelope.max_feed_ratio,
      .max_step_s = m.envelope.stale_after_s,
      // Without an M code to switch it on the law runs in every cut.
      .always = c.m_code_on == 0,
  });
}

Modulator::Modulator(const Config& config, Table spindle, std::optional<Table> feed)
    : config_(config),
      spindle_(std::move(spindle)),
      feed_(std::move(feed)),
      law_(config.modulation.law, config.modulation.seed),
      lowest_(spindle_.ceil_step(config.min_ratio).value_or(0)),
      highest_(spindle_.floor_step(config.max_ratio).value_or(0)) {
  spindle_delay_s_ = delay_s(config.spindle_table);
  if (feed_) {
    feed_delay_s_ = delay_s(config.feed_table);
    if (feed_->layer_may_exceed_panel()) {
      // Only a table that may exceed the panel lets the feed rise with the spindle.
      feed_top_ratio_ = std::clamp(std::min(feed_->max_ratio(), config.max_feed_ratio), 1.0, 10.0);
    }
  }
  state_.modulation = config.modulation;
}

}  // namespace steadyrest::chatter::online
