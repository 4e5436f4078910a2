// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>

#include <fmt/core.h>

#include <steadyrest/apps/cli/motion/verb_motion_units.hpp>
#include <steadyrest/apps/cli/shared/table.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/motion/offline/calculus/unit_calculus.hpp>

// Eqs. 3 and 4 of Kombarov 2011: v·T/q counts per tick and a·T²/q counts per tick², T = 1/cycle
// rate, q = count.
namespace steadyrest::apps::cli {
namespace motion_units {
namespace {

namespace offline = motion::offline;
using offline::Number;

struct Options {
  offline::Sampling sampling;
  std::optional<double> feed_mm_min;
  std::optional<double> counts_per_tick;
  std::optional<double> overload_g;
  std::optional<double> acceleration_mm_s2;
  std::optional<double> counts_per_tick2;
};

/// Eq. 3, from whichever side is given. A feed goes to counts; counts go to the feed and back, so
/// that both keys are always in the answer.
std::optional<Refusal> put_velocity(const Options& options, Answer& answer, Table& table) {
  const Number speed = options.feed_mm_min
                           ? Number(kernel::units::mm_s_from_mm_min(*options.feed_mm_min))
                           : offline::speed_mm_s(options.sampling, *options.counts_per_tick);
  if (!speed) {
    return speed.error();
  }
  const Number counts = offline::counts_per_tick(options.sampling, *speed);
  if (!counts) {
    return counts.error();
  }
  const double feed_mm_min = kernel::units::mm_min_from_mm_s(*speed);
  answer.json["feed_mm_min"] = feed_mm_min;
  answer.json["counts_per_tick"] = *counts;
  table.row({"feed", fmt::format("{:.6g} mm/min", feed_mm_min)})
      .row({"velocity", fmt::format("{:.6g} counts/tick", *counts)});
  return std::nullopt;
}

/// Three ways to give it; CLI11 lets only one through.
Number acceleration_of(const Options& options) {
  if (options.overload_g) {
    return offline::acceleration_of_overload_mm_s2(*options.overload_g);
  }
  if (options.acceleration_mm_s2) {
    return *options.acceleration_mm_s2;
  }
  return offline::acceleration_mm_s2(options.sampling, *options.counts_per_tick2);
}

/// Eq. 4, likewise; the overload is the acceleration in units of g.
std::optional<Refusal> put_acceleration(const Options& options, Answer& answer, Table& table) {
  const Number acceleration = acceleration_of(options);
  if (!acceleration) {
    return acceleration.error();
  }
  const Number counts = offline::counts_per_tick2(options.sampling, *acceleration);
  const Number overload = offline::overload_g(*acceleration);
  if (!counts || !overload) {
    return counts ? overload.error() : counts.error();
  }
  answer.json["overload_g"] = *overload;
  answer.json["acceleration_mm_s2"] = *acceleration;
  answer.json["counts_per_tick2"] = *counts;
  table.row({"overload", fmt::format("{:.6g} g", *overload)})
      .row({"acceleration", fmt::format("{:.6g} mm/s²", *acceleration)})
      .row({"acceleration", fmt::format("{:.6g} counts/tick²", *counts)});
  return std::nullopt;
}

/// Velocity and acceleration are independent; at least one must be given.
Outcome run(const Options& options) {
  const bool velocity = options.feed_mm_min || options.counts_per_tick;
  const bool acceleration =
      options.overload_g || options.acceleration_mm_s2 || options.counts_per_tick2;
  if (!velocity && !acceleration) {
    return refused(bad_input("nothing to convert",
                             "give --feed-mm-min, --overload-g or --acceleration-mm-s2, or "
                             "--counts-per-tick or --counts-per-tick2 for the way back"));
  }
  Answer answer;
  Table table;
  std::optional<Refusal> refusal;
  if (velocity) {
    refusal = put_velocity(options, answer, table);
  }
  if (acceleration && !refusal) {
    refusal = put_acceleration(options, answer, table);
  }
  if (refusal) {
    return refused(std::move(*refusal));
  }
  answer.json["count_mm"] = options.sampling.count_mm;
  answer.json["cycle_hz"] = options.sampling.cycle_hz;
  answer.text = table.text();
  return answer;
}

}  // namespace
}  // namespace motion_units

void add_verb_motion_units(Session& session, Verb& verb) {
  auto options = std::make_shared<motion_units::Options>();
  verb.add_option("--cycle-hz", options->sampling.cycle_hz, "Control cycles per second")
      ->required();
  verb.add_option("--count-mm", options->sampling.count_mm, "One count in mm")
      ->capture_default_str();
  auto* feed = verb.add_option("--feed-mm-min", options->feed_mm_min, "Feed in mm/min");
  verb.add_option("--counts-per-tick", options->counts_per_tick,
                  "Velocity in counts per cycle; gives the feed")
      ->excludes(feed);
  auto* overload =
      verb.add_option("--overload-g", options->overload_g, "Acceleration as a multiple of g");
  auto* acceleration =
      verb.add_option("--acceleration-mm-s2", options->acceleration_mm_s2, "Acceleration in mm/s²")
          ->excludes(overload);
  verb.add_option("--counts-per-tick2", options->counts_per_tick2,
                  "Acceleration in counts per cycle²; gives overload and mm/s²")
      ->excludes(overload)
      ->excludes(acceleration);
  check_size(verb);
  session.on(verb, [options](Progress& /*progress*/) { return motion_units::run(*options); });
}

}  // namespace steadyrest::apps::cli
