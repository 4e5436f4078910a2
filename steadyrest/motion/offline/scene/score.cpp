// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/motion/offline/scene/score.hpp>

namespace steadyrest::motion::offline {

// As in the cycle: all edges up to the tick, then the tick.
std::vector<online::Estimate> run(online::Estimator& estimator, const Record& record) {
  std::vector<online::Estimate> out;
  out.reserve(record.ticks.size());
  auto edge = record.edges.begin();
  for (const online::Tick& tick : record.ticks) {
    for (; edge != record.edges.end() && edge->t_s <= tick.t_s; ++edge) {
      estimator.edge(*edge);
    }
    out.push_back(estimator.tick(tick));
  }
  return out;
}

// For what can be known from sampled counts only.
Record without_edges(Record record) {
  record.edges.clear();
  return record;
}

// RMS, worst error and coverage in one pass. Coverage counts all scored ticks: an infinite bound
// covers, hence the bounds' RMS is given too.
Score score(const std::vector<online::Estimate>& estimates, const Record& record, double lag_s,
            double from_s, double min_speed_mm_s) {
  Score out;
  double v2 = 0.0;
  double a2 = 0.0;
  double bv2 = 0.0;
  double ba2 = 0.0;
  std::size_t in_v = 0;
  std::size_t in_a = 0;
  std::size_t at = 0;
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    // A lagging estimator is compared with the truth at its own instant: its error, not its delay.
    const double when = record.ticks[k].t_s - lag_s;
    while (at + 2 < record.ticks.size() && record.ticks[at + 1].t_s <= when) {
      ++at;
    }
    if (when < from_s || at + 1 >= record.ticks.size()) {
      continue;
    }
    // The truth between two ticks, linear: at 1 ms the error of that is J·T²/8.
    const double w =
        std::clamp((when - record.ticks[at].t_s) /
                       std::max(1e-12, record.ticks[at + 1].t_s - record.ticks[at].t_s),
                   0.0, 1.0);
    const MotionState& a = record.truth[at];
    const MotionState& b = record.truth[at + 1];
    const double true_v = a.velocity_mm_s + w * (b.velocity_mm_s - a.velocity_mm_s);
    const double true_a = a.acceleration_mm_s2 + w * (b.acceleration_mm_s2 - a.acceleration_mm_s2);
    if (std::abs(true_v) < min_speed_mm_s) {
      continue;
    }
    const online::Estimate& e = estimates[k];
    const double dv = std::abs(e.velocity_mm_s - true_v);
    const double da = std::abs(e.acceleration_mm_s2 - true_a);
    ++out.ticks;
    v2 += dv * dv;
    a2 += da * da;
    bv2 += e.velocity_bound_mm_s * e.velocity_bound_mm_s;
    ba2 += e.acceleration_bound_mm_s2 * e.acceleration_bound_mm_s2;
    in_v += dv <= e.velocity_bound_mm_s ? 1U : 0U;
    in_a += da <= e.acceleration_bound_mm_s2 ? 1U : 0U;
    out.velocity_max_mm_s = std::max(out.velocity_max_mm_s, dv);
    out.acceleration_max_mm_s2 = std::max(out.acceleration_max_mm_s2, da);
  }
  if (out.ticks > 0) {
    const auto n = static_cast<double>(out.ticks);
    out.velocity_rms_mm_s = std::sqrt(v2 / n);
    out.acceleration_rms_mm_s2 = std::sqrt(a2 / n);
    out.velocity_bound_mm_s = std::sqrt(bv2 / n);
    out.acceleration_bound_mm_s2 = std::sqrt(ba2 / n);
    out.velocity_coverage = static_cast<double>(in_v) / n;
    out.acceleration_coverage = static_cast<double>(in_a) / n;
  }
  return out;
}

}  // namespace steadyrest::motion::offline
