// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/motion/offline/calculus/unit_calculus.hpp>

// Equations 1 … 8 of Kombarov et al. in both directions. Each is one division or product; care is
// needed with the units (README "Units and encoders") and the refusals: wrong units give plausible
// numbers of the wrong size.
namespace steadyrest::motion::offline {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using kernel::outcome::refuse;

/// An input of an equation, by the user's name for it.
struct Given {
  std::string_view what;
  double value;
};

std::optional<Refusal> unfit(std::initializer_list<Given> values) {
  for (const Given& given : values) {
    if (!std::isfinite(given.value) || given.value <= 0.0) {
      return bad_input(
          fmt::format("{} = {:.10g}; allowed: a finite number above 0", given.what, given.value),
          "give a value above 0");
    }
  }
  return std::nullopt;
}

/// `law` of the values, unless one is unfit or the result leaves the range of a double.
template <class Law>
Number apply(std::initializer_list<Given> values, std::string_view result, Law law) {
  if (auto refusal = unfit(values)) {
    return std::unexpected(std::move(*refusal));
  }
  const double value = law();
  if (!std::isfinite(value) || value <= 0.0) {
    return refuse(fmt::format("{} comes out as {:.10g}", result, value),
                  "give values for a real machine");
  }
  return value;
}

constexpr std::string_view kCount = "count in mm";
constexpr std::string_view kCycle = "control cycle in Hz";
constexpr std::string_view kSpeed = "feed";
constexpr std::string_view kAcceleration = "acceleration in mm/s²";
constexpr std::string_view kFrequency = "signal frequency in Hz";
constexpr std::string_view kLines = "lines per revolution";
constexpr std::string_view kLead = "lead in mm per revolution";
constexpr std::string_view kTurn = "speed of rotation";

}  // namespace

// Eqs. 1 and 2: differences of the counts, whole numbers by nature.
std::vector<std::int64_t> tick_velocities(std::span<const std::int64_t> counts) {
  std::vector<std::int64_t> out;
  for (std::size_t i = 1; i < counts.size(); ++i) {
    out.push_back(counts[i] - counts[i - 1]);
  }
  return out;
}

std::vector<std::int64_t> tick_accelerations(std::span<const std::int64_t> counts) {
  return tick_velocities(tick_velocities(counts));
}

// Eq. 3: V = F/(d·f_c).
Number counts_per_tick(const Sampling& s, double speed_mm_s) {
  return apply({{kSpeed, speed_mm_s}, {kCount, s.count_mm}, {kCycle, s.cycle_hz}},
               "velocity in counts/tick", [&] { return speed_mm_s / (s.count_mm * s.cycle_hz); });
}

Number speed_mm_s(const Sampling& s, double counts_per_tick) {
  return apply({{"counts per tick", counts_per_tick}, {kCount, s.count_mm}, {kCycle, s.cycle_hz}},
               kSpeed, [&] { return counts_per_tick * s.count_mm * s.cycle_hz; });
}

// Eq. 4: a = n·g/(d·f_c²).
Number counts_per_tick2(const Sampling& s, double acceleration_mm_s2) {
  return apply({{kAcceleration, acceleration_mm_s2}, {kCount, s.count_mm}, {kCycle, s.cycle_hz}},
               "acceleration in counts/tick²",
               [&] { return acceleration_mm_s2 / (s.count_mm * s.cycle_hz * s.cycle_hz); });
}

Number acceleration_mm_s2(const Sampling& s, double counts_per_tick2) {
  return apply({{"counts per tick²", counts_per_tick2}, {kCount, s.count_mm}, {kCycle, s.cycle_hz}},
               kAcceleration,
               [&] { return counts_per_tick2 * s.count_mm * s.cycle_hz * s.cycle_hz; });
}

Number acceleration_of_overload_mm_s2(double overload_g) {
  return apply({{"overload in g", overload_g}}, kAcceleration,
               [&] { return overload_g * kGravity_mm_s2; });
}

Number overload_g(double acceleration_mm_s2) {
  return apply({{kAcceleration, acceleration_mm_s2}}, "overload in g",
               [&] { return acceleration_mm_s2 / kGravity_mm_s2; });
}

Number speed_gradations(const Sampling& s, double max_speed_mm_s) {
  const Number counts = counts_per_tick(s, max_speed_mm_s);
  // A whole number that rounding left slightly too small is still that number.
  return counts ? Number(std::floor(*counts * (1.0 + 1e-12))) : counts;
}

// The count at which the largest speed has as many gradations as the drive.
Number required_resolution_mm(const Sampling& s, double max_speed_mm_s, double drive_gradations) {
  return apply({{kSpeed, max_speed_mm_s},
                {"gradations of the drive", drive_gradations},
                {kCount, s.count_mm},
                {kCycle, s.cycle_hz}},
               "resolution in mm",
               [&] { return max_speed_mm_s / (s.cycle_hz * drive_gradations); });
}

// Eq. 5: f = n·Z, signal periods, before ×4 decoding.
Number signal_frequency_hz(double lines_per_rev, double speed_rev_s) {
  return apply({{kLines, lines_per_rev}, {kTurn, speed_rev_s}}, kFrequency,
               [&] { return lines_per_rev * speed_rev_s; });
}

// Eq. 6: Z = f·h/F, the finest encoder whose signal the electronics can follow at this feed.
Number lines_for_feed(double max_frequency_hz, double lead_mm, double speed_mm_s) {
  return apply({{kFrequency, max_frequency_hz}, {kLead, lead_mm}, {kSpeed, speed_mm_s}}, kLines,
               [&] { return max_frequency_hz * lead_mm / speed_mm_s; });
}

Number feed_for_lines_mm_s(double max_frequency_hz, double lead_mm, double lines_per_rev) {
  return apply({{kFrequency, max_frequency_hz}, {kLead, lead_mm}, {kLines, lines_per_rev}}, kSpeed,
               [&] { return max_frequency_hz * lead_mm / lines_per_rev; });
}

// Eq. 7: Z = f/n.
Number lines_for_speed(double max_frequency_hz, double speed_rev_s) {
  return apply({{kFrequency, max_frequency_hz}, {kTurn, speed_rev_s}}, kLines,
               [&] { return max_frequency_hz / speed_rev_s; });
}

Number speed_for_lines_rev_s(double max_frequency_hz, double lines_per_rev) {
  return apply({{kFrequency, max_frequency_hz}, {kLines, lines_per_rev}}, kTurn,
               [&] { return max_frequency_hz / lines_per_rev; });
}

// Eq. 8: d = h/(4Z), four counts to a line.
Number count_of_lines_mm(double lead_mm, double lines_per_rev) {
  return apply({{kLead, lead_mm}, {kLines, lines_per_rev}}, kCount,
               [&] { return lead_mm / (kCountsPerLine * lines_per_rev); });
}

Number lines_of_count(double lead_mm, double count_mm) {
  return apply({{kLead, lead_mm}, {kCount, count_mm}}, kLines,
               [&] { return lead_mm / (kCountsPerLine * count_mm); });
}

}  // namespace steadyrest::motion::offline
