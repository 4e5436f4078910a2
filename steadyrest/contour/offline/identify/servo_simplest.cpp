// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/contour/offline/identify/servo_simplest.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kMostLeft = 1.05;  // of the problem's floor, RMS
constexpr double kSharp = 1e-12;
constexpr std::size_t kTriedSamples = 3'000;
constexpr double kLeastBehind_s = 0.001;
constexpr double kApartSurely = 20.0;  // of −2·ln of the likelihood
constexpr double kFirstTriedLag_s = 0.0002;
constexpr double kLastTriedLag_s = 0.05;
constexpr double kTriedRatio = 1.4;

double rms_of(const ServoFitted& one) {
  return std::sqrt(one.square / static_cast<double>(std::max<std::size_t>(1, one.samples)));
}

bool is_enough(const ServoProblem& problem, const ServoFitted& one) {
  return one.samples > 0 && rms_of(one) <= kMostLeft * problem.floor;
}

/// Fitted to the last digit, though the record may not tell so much.
ServoFitted simple_fit(const ServoProblem& problem, double behind, double delay_s,
                       bool forward_too) {
  const ServoForm form = ServoForm{}.with({Free::forward}, forward_too);
  const double lag = std::max(behind - delay_s, kLeastBehind_s);
  const ServoProblem part = first_of(problem, kTriedSamples);
  const auto from = [&](double f) {
    const ServoLaw law{
        .gain_1_s = (1.0 - f) / lag, .feed_forward = forward_too ? f : 0.0, .delay_s = delay_s};
    return fit_law(part, law, form, {});
  };
  ServoFitted out = from(0.0);
  if (forward_too && !is_enough(problem, out)) {
    ServoFitted other = from(0.7);
    out = other.square < out.square ? std::move(other) : std::move(out);
  }
  ServoProblem sharp = problem;
  sharp.floor = kSharp;
  return fit_law(problem, fit_law(sharp, out.law, form, {}).law, form, {}, 0);
}

/// The longest τ with which gain and delay still make the law enough. Feed-forward's zero, were it
/// free, would take the lag's pole away.
double longest_lag_s(const ServoProblem& problem, const ServoFitted& simple) {
  double out = 0.0;
  ServoLaw law = simple.law;
  const ServoForm form = simple.form.with({Free::delay});
  for (double tau = kFirstTriedLag_s; tau < kLastTriedLag_s; tau *= kTriedRatio) {
    law.lag_s = tau;
    const ServoFitted one = fit_law(problem, law, form, {});
    if (!is_enough(problem, one)) {
      break;
    }
    out = tau;
    law = one.law;
  }
  return out;
}

/// Deviations are those with feed-forward free, lest a constant speed tell a gain.
ServoNumbers numbers_of(const ServoProblem& problem, const ServoFitted& fitted) {
  ServoNumbers out{.best = fitted};
  put_variance(problem, out.best);
  ServoFitted open =
      fit_law(problem, fitted.law, fitted.form.with({Free::forward}), fitted.colour, 0);
  put_variance(problem, open);
  for (std::size_t i = 0; i < kFree; ++i) {
    out.sd[i] = open.sd(static_cast<Free>(i));
  }
  return out;
}

/// Of the laws with this delay that are enough.
const ServoFitted* likeliest(const SimplestLaws& axis, std::size_t d) {
  const ServoFitted* out = nullptr;
  for (std::size_t f = 0; f < 2; ++f) {
    const ServoFitted& one = axis.fitted[d][f];
    out = axis.enough[d][f] && (out == nullptr || one.badness < out->badness) ? &one : out;
  }
  return out;
}

}  // namespace

SimplestLaws simplest_of(const ServoProblem& whole) {
  const ServoProblem problem = first_of(whole, kFittedSamples);
  const double behind = behind_s(problem);
  SimplestLaws out;
  for (std::size_t d = 0; d < 2; ++d) {
    for (std::size_t f = 0; f < 2; ++f) {
      const double delay_s = static_cast<double>(d) * problem.period_s;
      out.fitted[d][f] = simple_fit(problem, behind, delay_s, f == 1);
      out.enough[d][f] = is_enough(problem, out.fitted[d][f]);
    }
  }
  return out;
}

std::optional<std::vector<ServoNumbers>> enough_for_all(
    const std::vector<const ServoProblem*>& problems, const std::vector<SimplestLaws>& axes) {
  bool enough[2] = {true, true};
  double badness[2] = {};
  for (std::size_t d = 0; d < 2; ++d) {
    for (const SimplestLaws& axis : axes) {
      const ServoFitted* one = likeliest(axis, d);
      enough[d] = enough[d] && one != nullptr;
      badness[d] += one != nullptr ? one->badness : 0.0;
    }
  }
  if (!enough[0] && !enough[1]) {
    return std::nullopt;
  }
  const std::size_t d = !enough[0] || (enough[1] && badness[1] < badness[0]) ? 1 : 0;
  const bool open = enough[1 - d] && badness[1 - d] - badness[d] < kApartSurely;
  std::vector<ServoNumbers> out;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const ServoProblem problem = first_of(*problems[i], kFittedSamples);
    const ServoFitted& fitted = *likeliest(axes[i], d);
    ServoNumbers& one = out.emplace_back(numbers_of(problem, fitted));
    one.most_lag_s = longest_lag_s(first_of(problem, kTriedSamples), fitted);
    one.sd[static_cast<std::size_t>(Free::delay)] = open ? problem.period_s : 0.0;
  }
  return out;
}

std::optional<ServoNumbers> in_place_of(const ServoProblem& whole, const SimplestLaws& simplest,
                                        const ServoNumbers& larger) {
  const ServoProblem problem = first_of(whole, kFittedSamples);
  const ServoFitted best =
      fit_law(problem, larger.best.law, larger.best.form, larger.best.colour, 0);
  std::optional<ServoFitted> found;
  for (const auto& of_delay : simplest.fitted) {
    for (const ServoFitted& simple : of_delay) {
      const ServoFitted one = fit_law(problem, simple.law, simple.form, larger.best.colour);
      if (!found || one.badness < found->badness) {
        found = one;
      }
    }
  }
  if (found->badness > best.badness + kApartSurely * larger.best.dispersion) {
    return std::nullopt;
  }
  ServoNumbers out = numbers_of(problem, *found);
  out.least_lag_s = 0.0;
  out.most_lag_s = larger.most_lag_s;
  constexpr auto kDelayAt = static_cast<std::size_t>(Free::delay);
  out.sd[kDelayAt] = larger.sd[kDelayAt];
  return out;
}

}  // namespace steadyrest::contour::offline
