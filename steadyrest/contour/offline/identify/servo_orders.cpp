// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <steadyrest/contour/offline/identify/servo_orders.hpp>

namespace steadyrest::contour::offline {
namespace {

using enum Free;

constexpr double kShortLag_s = 0.001;
constexpr double kLongLag_s = 0.015;
constexpr double kLeastModeGain = 6.0;  // in −2·ln of the likelihood
constexpr double kApart = 17.0;         // beyond what two numbers fewer may win
constexpr double kUnlikely = 20.0;
constexpr double kOtherStart = 20.0;
constexpr double kRepeats = 12.0;
constexpr double kCancels = 0.05;
constexpr int kFirstRounds = 8;
constexpr std::size_t kSearchSamples = 5'000;  // where the search begins
constexpr int kModes = 24;
constexpr std::size_t kBestModes = 3;
constexpr double kLowest_hz = 12.0;
constexpr double kHighest_hz = 200.0;
constexpr double kWeight = 1e-3;  // to begin with

const ServoForm kWhole = ServoForm{}.with({forward, lag, delay});

double behind_s(const ServoLaw& law) {
  return law.delay_s + (1.0 - law.feed_forward) / law.gain_1_s;
}

/// With this gain the axis falls as far behind as it did.
void keep_behind(double behind, ServoLaw& law) {
  const bool leads = law.feed_forward > 1.0 && behind < law.delay_s;
  const double lag =
      leads ? std::min(behind - law.delay_s, -5e-4) : std::max(behind - law.delay_s, 5e-4);
  law.gain_1_s = std::max((1.0 - law.feed_forward) / lag, 1.0);
}

std::vector<ServoLaw> starts_of(const ServoProblem& problem) {
  const double seen = behind_s(problem);
  const double behind = std::max(seen, 0.001);
  std::vector<ServoLaw> out;
  if (seen < 0.0) {  // only too much feed-forward makes an axis lead
    keep_behind(seen, out.emplace_back(ServoLaw{.feed_forward = 1.2, .lag_s = kShortLag_s}));
  }
  for (const double lag_s : {kShortLag_s, kLongLag_s}) {
    for (const bool forward_too : {false, true}) {
      ServoLaw law{.feed_forward = forward_too ? 0.7 : 0.02,
                   .lag_s = lag_s,
                   .delay_s = forward_too ? 0.3 * behind : 0.1 * problem.period_s};
      keep_behind(behind, law);
      out.push_back(law);
    }
  }
  return out;
}

/// Fits from each start until one leaves white noise, and takes the best.
ServoFitted from_starts(const ServoProblem& problem, const std::vector<ServoLaw>& starts,
                        const ServoForm& form) {
  std::optional<ServoFitted> best;
  for (const ServoLaw& start : starts) {
    const ServoFitted one = fit_law(problem, start, form, {}, kFirstRounds);
    if (!best || one.square < best->square) {
      best = one;
    }
  }
  return fit_law(problem, best->law, form, {});
}

ServoFitted coloured(const ServoProblem& problem, const ServoFitted& white) {
  ServoFitted out = fit_law(problem, white.law, white.form, {});
  for (int i = 0; i < 2; ++i) {
    const auto colour = colour_of(problem, out.law);
    if (colour.empty() && out.colour.empty()) {
      break;
    }
    out = fit_law(problem, out.law, out.form, colour);
  }
  return out;
}

ServoFitted with_second(const ServoProblem& problem, const ServoFitted& white) {
  ServoLaw law = white.law;
  law.lag_s = std::max(law.lag_s, kShortLag_s);
  law.second = 0.3;
  const ServoFitted out = fit_law(problem, law, white.form.with({second}), {});
  return out.badness < white.badness ? out : white;
}

/// With what is lost at reversals, where it repeats.
ServoFitted with_lost(const ServoProblem& problem, const ServoFitted& white) {
  // What is left of the reversals is about a third of what is lost.
  ServoLaw law = white.law;
  law.lost =
      3.0 * std::sqrt(white.square / static_cast<double>(std::max<std::size_t>(1, white.samples)));
  const ServoFitted out = fit_law(problem, law, white.form.with({lost}), {});
  return out.law.lost > 0.0 && out.badness + kRepeats < white.badness ? out : white;
}

/// Frequencies to look for a mode at, near enough for one of 5 % damping.
std::vector<double> modes_rad_s(const ServoProblem& problem) {
  const double highest = std::min(kHighest_hz, 0.4 / problem.period_s);
  std::vector<double> out;
  out.reserve(kModes);
  for (int i = 0; i < kModes; ++i) {
    out.push_back(2.0 * std::numbers::pi * kLowest_hz *
                  std::pow(highest / kLowest_hz, i / (kModes - 1.0)));
  }
  return out;
}

/// Whether any mode explains what is left, the other numbers free to move.
bool may_have_mode(const ServoProblem& problem, const ServoFitted& white) {
  return std::ranges::any_of(modes_rad_s(problem), [&](double rad_s) {
    return mode_gain(problem, white, rad_s) > kLeastModeGain;
  });
}

/// The law with the mode that explains most; empty where none does.
std::optional<ServoFitted> with_mode(const ServoProblem& problem, const ServoFitted& white,
                                     const std::vector<ServoLaw>& starts) {
  if (!may_have_mode(problem, white)) {
    return std::nullopt;
  }
  // A mode bends the law without it, so it need not show where it is. Free, its damping would
  // make it a filter for everything.
  std::vector<ServoFitted> tried;
  for (const double rad_s : modes_rad_s(problem)) {
    ServoLaw law = white.law;
    law.mode_rad_s = rad_s;
    law.mode_damping = 0.05;
    law.mode_weight = kWeight;
    tried.push_back(fit_law(problem, law, white.form.with({weight}), {}, kFirstRounds));
  }
  std::ranges::sort(tried, {}, &ServoFitted::square);
  std::vector<ServoLaw> from;
  from.reserve(kBestModes);
  for (std::size_t i = 0; i < kBestModes; ++i) {
    from.push_back(tried[i].law);
  }
  for (ServoLaw law : starts) {
    law.mode_rad_s = from[0].mode_rad_s;
    law.mode_damping = 0.05;
    law.mode_weight = kWeight;
    law.second = white.law.second;
    from.push_back(law);
  }
  return from_starts(problem, from, white.form.with({mode, damping, weight}));
}

/// The lattice of laws below one that has everything.
class Lattice {
 public:
  Lattice(const ServoProblem& problem, std::vector<ServoCandidate>& all, const ServoFitted& top)
      : problem_(problem), all_(all), top_(top), behind_s_(behind_s(top.law)) {}

  void whole() {
    for (std::size_t d = 0; d < kDelays; ++d) {
      add(top_.law, top_.form, d);
    }
  }
  void reduce(double best) {
    for (std::size_t d = 0; d < kDelays; ++d) {
      const ServoFitted from = all_[first_ + d].fitted;
      if (from.badness > best + kApart) {
        continue;
      }
      for (const bool forward_too : {true, false}) {
        for (int order = from.form.has(second) ? 2 : 1; order >= 0; --order) {
          ServoForm form = from.form.with({forward}, forward_too);
          form = form.with({lag}, order > 0).with({second}, order > 1);
          if (form.count() < from.form.count()) {
            add(from.law, form, d);
          }
        }
      }
    }
  }
  void begin() { first_ = all_.size(); }

 private:
  [[nodiscard]] ServoFitted fit(ServoLaw law, const ServoForm& form, std::size_t d) const {
    if (d + 1 < kDelays) {
      law.delay_s = 0.5 * static_cast<double>(d) * problem_.period_s;
    }
    law.feed_forward = form.has(forward) ? law.feed_forward : 0.0;
    law.lag_s = form.has(lag) ? std::max(law.lag_s, 5e-4) : 0.0;
    keep_behind(behind_s_, law);
    return fit_law(problem_, law, form.with({delay}, d + 1 == kDelays), top_.colour);
  }
  void add(const ServoLaw& law, const ServoForm& form, std::size_t d) {
    ServoFitted one = fit(law, form, d);
    const ServoFitted* best = nullptr;
    for (std::size_t i = first_; i < all_.size(); ++i) {
      best = best == nullptr || all_[i].fitted.badness < best->badness ? &all_[i].fitted : best;
    }
    if (best != nullptr && one.badness > best->badness + kOtherStart) {
      ServoFitted other = fit(best->law, form, d);
      one = other.badness < one.badness ? std::move(other) : std::move(one);
    }
    all_.push_back({d, std::move(one)});
  }

  const ServoProblem& problem_;
  std::vector<ServoCandidate>& all_;
  const ServoFitted& top_;
  double behind_s_;
  std::size_t first_ = 0;
};

/// A number at the end of its range says the same as the law without it.
bool repeats(const ServoFitted& fitted) {
  return (fitted.form.has(lag) && fitted.law.lag_s < 2.1e-5) ||
         (fitted.form.has(second) && fitted.law.second < 0.0201) ||
         (fitted.form.has(forward) && fitted.law.feed_forward <= 0.0) ||
         (fitted.form.has(weight) &&
          (fitted.law.mode_damping < 0.0031 || fitted.law.mode_damping > 0.299));
}

/// Feed-forward's zero takes the lag's pole away: a simpler law with more numbers.
bool cancels(const ServoLaw& law) {
  const double zero = law.gain_1_s / std::max(law.feed_forward, 1e-9);
  const double left = law.lag_s * zero - 1.0 + law.feed_forward;
  return law.lag_s > 0.0 && law.feed_forward > 0.0 && std::abs(left) < kCancels;
}

}  // namespace

std::vector<ServoCandidate> candidates_of(const ServoProblem& whole) {
  ServoProblem problem = first_of(whole, kFittedSamples);
  const ServoProblem part = first_of(problem, kSearchSamples);
  const auto starts = starts_of(part);
  const ServoFitted white = with_lost(part, with_second(part, from_starts(part, starts, kWhole)));
  std::vector<ServoFitted> tops{coloured(problem, white)};
  if (const auto moded = with_mode(part, white, starts)) {
    ServoFitted top = coloured(problem, *moded);
    if (top.badness < tops[0].badness + kApart) {
      tops.push_back(std::move(top));
    }
  }
  put_variance(problem, tops.back());
  problem.dispersion = tops.back().dispersion;
  std::vector<ServoCandidate> out;
  std::vector<Lattice> lattices;
  for (const ServoFitted& top : tops) {
    Lattice& one = lattices.emplace_back(problem, out, top);
    one.begin();
    one.whole();
  }
  const auto badness = [](const ServoCandidate& one) { return one.fitted.badness; };
  const double best = std::ranges::min(out, {}, badness).fitted.badness;
  for (Lattice& one : lattices) {
    one.reduce(best);
  }
  std::erase_if(out, [&](const ServoCandidate& one) { return repeats(one.fitted); });
  const double last = std::ranges::min(out, {}, badness).fitted.badness;
  std::erase_if(out, [&](const ServoCandidate& one) {
    return cancels(one.fitted.law) && one.fitted.badness > last;
  });
  for (ServoCandidate& one : out) {
    if (one.fitted.badness < last + kUnlikely) {
      put_variance(problem, one.fitted);
    }
  }
  return out;
}

ServoNumbers best_of(const std::vector<ServoCandidate>& candidates,
                     const std::vector<double>& against) {
  const auto badness = [&](const ServoCandidate& one) {
    return one.fitted.badness + against[one.delay];
  };
  const ServoCandidate& best = std::ranges::min(candidates, {}, badness);
  ServoNumbers out{.best = best.fitted};
  out.least_lag_s = out.most_lag_s = best.fitted.law.lag_s;
  double sum = 0.0;
  double square[kFree] = {};
  const auto numbers = [](const ServoLaw& law) {
    return std::array{law.gain_1_s, law.feed_forward, law.lag_s, law.second, law.delay_s};
  };
  const auto at = numbers(best.fitted.law);
  for (const ServoCandidate& one : candidates) {
    const double weight = std::exp(-0.5 * (badness(one) - badness(best)));
    if (weight < 1e-4 || one.fitted.variance.size() == 0) {
      continue;
    }
    sum += weight;
    const auto other = numbers(one.fitted.law);
    for (std::size_t i = 0; i < at.size(); ++i) {
      const double sd = one.fitted.sd(static_cast<Free>(i));
      const double off = other.at(i) - at.at(i);
      square[i] += weight * (sd * sd + off * off);
    }
    if (weight > 0.02) {
      const double band = 2.0 * one.fitted.sd(lag);
      out.least_lag_s = std::min(out.least_lag_s, std::max(0.0, other[2] - band));
      out.most_lag_s = std::max(out.most_lag_s, other[2] + band);
    }
  }
  for (std::size_t i = 0; i < kFree; ++i) {
    out.sd[i] = i < at.size() ? std::sqrt(square[i] / std::max(sum, 1e-300))
                              : best.fitted.sd(static_cast<Free>(i));
  }
  return out;
}

}  // namespace steadyrest::contour::offline
