// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include <steadyrest/contour/offline/identify/servo_checks.hpp>
#include <steadyrest/contour/offline/identify/servo_fit.hpp>
#include <steadyrest/contour/offline/identify/servo_simplest.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::machine::Axis;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr std::size_t kLeastReversals = 3;
constexpr double kNoSuchDelay = 1e6;

/// What the axis loses at a reversal.
void add_lost_motion(const ServoSubject& subject, const ServoNumbers& found, ServoFit& out) {
  for (const auto& c : subject.problem.command) {
    out.reversals += static_cast<std::size_t>(
        std::ranges::count_if(reversals(c, rest_step(c)), [](int turn) { return turn != 0; }));
  }
  if (out.reversals < kLeastReversals) {
    return;
  }
  ServoFitted with = found.best;
  if (!with.form.has(Free::lost)) {
    with = fit_law(subject.problem, with.law, with.form.with({Free::lost}), with.colour);
  }
  put_variance(subject.problem, with);
  out.lost_motion = with.law.lost;
  out.lost_motion_sd = with.sd(Free::lost);
}

Result<ServoFit> make_fit(const ServoSubject& subject, const ServoNumbers& found) {
  ServoFit out{.axis = subject.axis.name, .rotary = subject.axis.rotary};
  add_lost_motion(subject, found, out);
  const ServoLaw& law = found.best.law;
  const ServoMisfit off = misfit_of(subject.problem, law);
  if (auto checked = check_fit(subject, found, off); !checked) {
    return std::unexpected(checked.error());
  }
  out.gain_1_s = law.gain_1_s;
  out.gain_sd_1_s = found.sd[0];
  out.feed_forward = std::clamp(law.feed_forward, 0.0, 1.0);
  out.feed_forward_sd = found.sd[1];
  out.lag_s = law.lag_s;
  out.lag_sd_s = found.sd[2];
  out.least_lag_s = found.least_lag_s;
  out.most_lag_s = found.most_lag_s;
  out.second_order = law.second > 0.0;
  out.delay_s = law.delay_s;
  out.delay_sd_s = found.sd[4];
  out.mode_hz = found.best.form.has(Free::weight) ? law.mode_rad_s / (2.0 * std::numbers::pi) : 0.0;
  out.mode_damping = law.mode_damping;
  out.mode_weight = law.mode_weight;
  out.determined = is_determined(found);
  out.rest_error = law.rest_error;
  out.rms = off.rms;
  out.largest = off.largest;
  out.hard_rms = off.hard_rms;
  out.calm_rms = off.calm_rms;
  out.samples = subject.moves.samples;
  return out;
}

/// The least badness of each delay.
std::vector<double> by_delay(const std::vector<ServoCandidate>& candidates) {
  std::vector<double> out(kDelays, kNoSuchDelay);
  const auto badness = [](const ServoCandidate& one) { return one.fitted.badness; };
  const double best = std::ranges::min(candidates, {}, badness).fitted.badness;
  for (const ServoCandidate& one : candidates) {
    out[one.delay] = std::min(out[one.delay], one.fitted.badness - best);
  }
  return out;
}

/// Each axis's numbers, one kind of delay for all; where it is free, one value too, weighted by
/// what each axis says of it.
std::vector<ServoNumbers> joined(const std::vector<ServoSubject>& subjects,
                                 const std::vector<std::vector<ServoCandidate>>& candidates) {
  std::vector<double> all(kDelays, 0.0);
  for (const auto& axis : candidates) {
    const auto own = by_delay(axis);
    std::ranges::transform(all, own, all.begin(), std::plus<>());
  }
  std::vector<ServoNumbers> out;
  double sum = 0.0;
  double weights = 0.0;
  for (const auto& axis : candidates) {
    std::vector<double> others = all;
    std::ranges::transform(others, by_delay(axis), others.begin(), std::minus<>());
    const ServoNumbers& one = out.emplace_back(best_of(axis, others));
    const double weight = 1.0 / (std::pow(one.best.sd(Free::delay), 2) + 1e-16);
    sum += weight * one.best.law.delay_s;
    weights += weight;
  }
  for (std::size_t i = 0; i < out.size() && out.size() > 1; ++i) {
    ServoFitted& best = out[i].best;
    if (best.form.has(Free::delay)) {
      ServoLaw law = best.law;
      law.delay_s = sum / weights;
      best = fit_law(subjects[i].problem, law, best.form.with({Free::delay}, false), best.colour);
      out[i].sd[4] = std::min(out[i].sd[4], 1.0 / std::sqrt(weights));
    }
  }
  return out;
}

/// Each axis's numbers from the simplest law up: where none of them is enough, what the likelihood
/// supports.
std::vector<ServoNumbers> numbers_of_all(const std::vector<ServoSubject>& subjects,
                                         const std::vector<SimplestLaws>& simplest) {
  std::vector<const ServoProblem*> problems;
  problems.reserve(subjects.size());
  for (const ServoSubject& subject : subjects) {
    problems.push_back(&subject.problem);
  }
  if (auto enough = enough_for_all(problems, simplest)) {
    return std::move(*enough);
  }
  std::vector<std::vector<ServoCandidate>> candidates;
  candidates.reserve(subjects.size());
  for (const ServoSubject& subject : subjects) {
    candidates.push_back(candidates_of(subject.problem));
  }
  return joined(subjects, candidates);
}

/// The fit by these numbers; where it is refused, by fewer.
Result<ServoFit> settled_fit(const ServoSubject& subject, const SimplestLaws& simplest,
                             const ServoNumbers& found) {
  auto out = make_fit(subject, found);
  if (const auto smaller = out ? std::nullopt : in_place_of(subject.problem, simplest, found)) {
    if (auto other = make_fit(subject, *smaller)) {
      return other;
    }
  }
  return out;
}

}  // namespace

Result<ServoFits> fit_servos(const std::vector<ServoLog>& logs, const std::vector<Axis>& axes) {
  ServoFits out;
  std::vector<ServoSubject> subjects;
  std::vector<SimplestLaws> simplest;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (logs[i].time_s.size() < 2) {
      return refuse("the record holds no samples", "give the record of a run with a program");
    }
    out.period_s = servo_period_s(logs[i].time_s);
    auto subject = prepared_subject(axes[i], logs[i], out.period_s);
    if (!subject) {
      return std::unexpected(subject.error());
    }
    subjects.push_back(std::move(*subject));
    simplest.push_back(simplest_of(subjects.back().problem));
  }
  out.shift_certain = true;
  const auto found = numbers_of_all(subjects, simplest);
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    auto fit = settled_fit(subjects[i], simplest[i], found[i]);
    if (!fit) {
      return std::unexpected(fit.error());
    }
    fit->shift_cycles = static_cast<int>(std::lround(fit->delay_s / out.period_s));
    out.shift_certain = out.shift_certain && fit->delay_sd_s < 0.25 * out.period_s;
    out.axes.push_back(std::move(*fit));
  }
  return out;
}

}  // namespace steadyrest::contour::offline
