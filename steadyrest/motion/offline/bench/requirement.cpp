// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <fmt/format.h>

#include <steadyrest/motion/offline/bench/bench_scenes.hpp>
#include <steadyrest/motion/offline/bench/requirement.hpp>
#include <steadyrest/motion/offline/scene/score.hpp>

// The paper's requirement per tick, converted to mm/s and mm/s² by the cycle, against three
// figures: the best possible guarantee (Landau, Kolmogorov), the average of the best possible
// estimator, and what ours proves and reaches.
namespace steadyrest::motion::offline {
namespace {

using kernel::outcome::Result;

// Per tick and per tick², coarse and fine end.
constexpr double kVelocity_mm_tick[] = {1e-5, 3e-6};
constexpr double kAcceleration_mm_tick2[] = {1e-5, 1e-6};

// Forbidden is not our failure: even the physical limit is above the requirement.
Verdict verdict(double value, double least, double required) {
  if (value <= required) {
    return Verdict::met;
  }
  return least > required ? Verdict::forbidden : Verdict::missed;
}

struct Measured {
  MotionError rms;
  MotionError bound;
};

// One scene serves all jerk limits: the motion is the same, only the limit given to the estimator
// differs.
Result<Measured> measure(BenchScene& scene, double jerk_mm_s3) {
  scene.setup.max_jerk_mm_s3 = jerk_mm_s3;
  auto estimator = make_estimator(estimator_names().front(), scene.setup);
  if (!estimator) {
    return std::unexpected(estimator.error());
  }
  const Record& record = scene.records.front();
  const std::vector<online::Estimate> estimates = run(**estimator, record);
  double sums[4] = {};
  double n = 0.0;
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    if (scene.scored.front()[k] == 0) {
      continue;
    }
    const online::Estimate& e = estimates[k];
    const double values[4] = {e.velocity_mm_s - record.truth[k].velocity_mm_s,
                              e.acceleration_mm_s2 - record.truth[k].acceleration_mm_s2,
                              e.velocity_bound_mm_s, e.acceleration_bound_mm_s2};
    for (int i = 0; i < 4; ++i) {
      sums[i] += values[i] * values[i];
    }
    n += 1.0;
  }
  return Measured{{std::sqrt(sums[0] / n), std::sqrt(sums[1] / n)},
                  {std::sqrt(sums[2] / n), std::sqrt(sums[3] / n)}};
}

/// The four rows of one condition: both quantities, both ends of the requirement.
void put(const RequirementRow& condition, const BenchScene& scene, const Measured& measured,
         std::vector<RequirementRow>& out) {
  EdgeQuality quality{condition.speed_mm_s, scene.setup.count_mm, condition.clock_s,
                      scene.setup.line_error_mm.value_or(0.0), condition.jerk_mm_s3};
  // The guaranteed floor uses the bound of the line error, the stochastic optimum its RMS.
  const MotionError least = guaranteed_floor(quality);
  quality.line_error_mm = condition.line_error_counts * scene.setup.count_mm;
  const MotionError optimum = stochastic_optimum(quality);
  for (int i = 0; i < 4; ++i) {
    RequirementRow row = condition;
    row.acceleration = i >= 2;
    row.fine = i % 2 == 1;
    const auto end = static_cast<std::size_t>(i % 2);
    const auto of = [&](const MotionError& e) {
      return row.acceleration ? e.acceleration_mm_s2 : e.velocity_mm_s;
    };
    row.required = row.acceleration ? kAcceleration_mm_tick2[end] * row.cycle_hz * row.cycle_hz
                                    : kVelocity_mm_tick[end] * row.cycle_hz;
    row.guaranteed_floor = of(least);
    row.bound = of(measured.bound);
    row.optimum = of(optimum);
    row.rms = of(measured.rms);
    row.guaranteed = verdict(row.bound, row.guaranteed_floor, row.required);
    row.typical = verdict(row.rms, row.optimum, row.required);
    out.push_back(row);
  }
}

}  // namespace

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::met:
      return "met";
    case Verdict::forbidden:
      return "forbidden";
    case Verdict::missed:
      break;
  }
  return "missed";
}

Result<std::vector<RequirementRow>> requirement_table(const RequirementConfig& config,
                                                      const std::function<void(double)>& progress) {
  std::vector<RequirementRow> out;
  const auto all = static_cast<double>(config.speeds_mm_s.size() * config.clocks_s.size() *
                                       config.line_errors_counts.size() * config.cycles_hz.size() *
                                       config.jerks_mm_s3.size() * 4);
  for (const double speed : config.speeds_mm_s) {
    for (const double clock_s : config.clocks_s) {
      for (const double line : config.line_errors_counts) {
        for (const double cycle_hz : config.cycles_hz) {
          // A whole number of counts in a tick would be a special case.
          const double v = 1.0764 * speed;
          BenchScene scene = cruise(
              v, {.cycle_hz = cycle_hz, .clock_s = clock_s, .line_error_counts = line}, 5000.0);
          for (const double jerk : config.jerks_mm_s3) {
            const auto measured = measure(scene, jerk);
            if (!measured) {
              return std::unexpected(measured.error());
            }
            RequirementRow condition;
            condition.speed_mm_s = v;
            condition.clock_s = clock_s;
            condition.line_error_counts = line;
            condition.jerk_mm_s3 = jerk;
            condition.cycle_hz = cycle_hz;
            put(condition, scene, *measured, out);
            if (progress) {
              progress(static_cast<double>(out.size()) / all);
            }
          }
        }
      }
    }
  }
  return out;
}

std::string to_csv(const std::vector<RequirementRow>& rows) {
  std::string out =
      "speed_mm_s,clock_s,line_error_counts,jerk_mm_s3,cycle_hz,quantity,unit,end,required,"
      "guaranteed_floor,bound,guaranteed,stochastic_optimum,rms,typical\n";
  for (const RequirementRow& row : rows) {
    out += fmt::format(
        "{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{},{},{:.6g},{:.6g},{:.6g},{},{:.6g},"
        "{:.6g},{}\n",
        row.speed_mm_s, row.clock_s, row.line_error_counts, row.jerk_mm_s3, row.cycle_hz,
        row.acceleration ? "acceleration" : "velocity", row.acceleration ? "mm/s2" : "mm/s",
        row.fine ? "fine" : "coarse", row.required, row.guaranteed_floor, row.bound,
        name(row.guaranteed), row.optimum, row.rms, name(row.typical));
  }
  return out;
}

}  // namespace steadyrest::motion::offline
