// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Dense>

#include <steadyrest/thermal/offline/adapt/adapt.hpp>

// Loop D of Marusich 2012. next_level() looks only at the parts and moves the share k by one step;
// predict() gives the plan's expectation for each part; learn_gains() finds the mode gains that
// would have explained the parts, by recursive least squares, removing outliers one after another.
namespace steadyrest::thermal::offline {
namespace {

constexpr std::size_t kLeastForFit = 4;
/// Up to this many observations at most one is removed per round, beyond it the worst together, so
/// the number of rounds does not grow with the observations.
constexpr std::size_t kRounds = 400;
constexpr double kNormal999 = 3.2905;
constexpr double kUpper999 = 3.0902;

/// Wilson and Hilferty 1931.
double chi_square_999(double n) {
  const double root = 1.0 - 2.0 / (9.0 * n) + kUpper999 * std::sqrt(2.0 / (9.0 * n));
  return n * root * root * root;
}

/// One pass over the observations; parameters are g_i − 1 and b.
class Pass {
 public:
  Pass(std::span<const Observation> observations, const GainRule& rule)
      : observations_(observations),
        rule_(rule),
        modes_(observations.front().mode_mm.size()),
        x_(Eigen::VectorXd::Zero(size())),
        p_(Eigen::MatrixXd::Zero(size(), size())) {
    p_.diagonal().setConstant(rule.gain_sd_ratio * rule.gain_sd_ratio);
    // The modes' parameters are ratios, the bias is a length.
    p_(size() - 1, size() - 1) = rule.bias_sd_mm * rule.bias_sd_mm;
  }

  void run(const std::vector<bool>& left_out) {
    out_ = left_out;
    innovation_.reserve(observations_.size());
    for (std::size_t k = 0; k < observations_.size(); ++k) {
      if (!left_out[k]) {
        take(k);
      }
    }
  }

  [[nodiscard]] const std::vector<bool>& out() const { return out_; }

  /// Residual of an observation with the present parameters.
  [[nodiscard]] double left_mm(std::size_t k) const {
    const Observation& o = observations_[k];
    return o.deviation_mm - o.expected_mm - row(o).dot(x_);
  }

  [[nodiscard]] Gains gains() const {
    Gains out;
    for (std::size_t i = 0; i < modes_; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const double gain = 1.0 + x_(at);
      out.gain.push_back(std::clamp(gain, rule_.min_gain, rule_.max_gain));
      out.clamped = out.clamped || out.gain.back() != gain;
      out.gain_sd.push_back(std::sqrt(std::max(p_(at, at), 0.0)));
    }
    out.bias_mm = x_(size() - 1);
    for (std::size_t k = 0; k < out_.size(); ++k) {
      if (out_[k]) {
        out.outlier.push_back(k);
      }
    }
    rms(out);
    const auto all = static_cast<double>(observations_.size());
    const auto n = static_cast<double>(innovation_.size());
    const double energy =
        std::inner_product(innovation_.begin(), innovation_.end(), innovation_.begin(), 0.0);
    const double sum = std::accumulate(innovation_.begin(), innovation_.end(), 0.0);
    const bool told = innovation_.size() >= kLeastForFit;
    const bool wide =
        told && (energy > chi_square_999(n) || std::abs(sum) > kNormal999 * std::sqrt(n));
    out.few = observations_.size() < kLeastForFit;
    // With few parts nobody can tell whether they or the model are wrong: one is enough.
    const bool many = static_cast<double>(out.outlier.size()) > (out.few ? 0.0 : 0.25 * all);
    out.fits = !wide && !many && !out.clamped;
    return out;
  }

 private:
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(modes_) + 1; }

  [[nodiscard]] Eigen::VectorXd row(const Observation& o) const {
    Eigen::VectorXd h(size());
    for (std::size_t i = 0; i < modes_; ++i) {
      h(static_cast<Eigen::Index>(i)) = o.mode_mm[i];
    }
    h(size() - 1) = 1.0;
    return h;
  }

  // The order hardly affects the result but matters for the outliers: the first parts are judged by
  // the prior. learn_gains() therefore judges all of them again at the end.
  void take(std::size_t k) {
    const Eigen::VectorXd h = row(observations_[k]);
    const Eigen::VectorXd ph = p_ * h;
    const double s = h.dot(ph) + rule_.measuring_sd_mm * rule_.measuring_sd_mm;
    const double innovation = left_mm(k);
    const double e = innovation / std::sqrt(s);
    // Clipped: one bad part alone must not condemn the model.
    innovation_.push_back(std::clamp(e, -rule_.gate_sd, rule_.gate_sd));
    if (std::abs(e) > rule_.gate_sd) {
      out_[k] = true;
      return;
    }
    x_ += ph * (innovation / s);
    p_ -= ph * ph.transpose() / s;
  }

  void rms(Gains& out) const {
    double before = 0.0;
    double after = 0.0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < observations_.size(); ++k) {
      if (!out_[k]) {
        const double was = observations_[k].deviation_mm - observations_[k].expected_mm;
        before += was * was;
        after += left_mm(k) * left_mm(k);
        ++count;
      }
    }
    if (count > 0) {
      out.rms_before_mm = std::sqrt(before / static_cast<double>(count));
      out.rms_after_mm = std::sqrt(after / static_cast<double>(count));
    }
  }

  std::span<const Observation> observations_;
  GainRule rule_;
  std::size_t modes_;
  Eigen::VectorXd x_;
  Eigen::MatrixXd p_;
  std::vector<bool> out_;  ///< of each observation: not taken
  std::vector<double> innovation_;
};

}  // namespace

LevelChoice next_level(std::span<const double> share, std::uint32_t level,
                       std::span<const PartError> parts, const LevelRule& rule) {
  LevelChoice out{.level = level, .share = share[level]};
  bool all_inside = parts.size() >= rule.least;
  for (const PartError& part : parts) {
    // k·Δ. Twice the measuring error does not count against a part.
    const double own = out.share * part.tolerance_mm;
    const double error = std::abs(part.deviation_mm);
    out.outside += error > own + 2.0 * rule.measuring_sd_mm ? 1U : 0U;
    out.largest_ratio = std::max(out.largest_ratio, error / own);
    all_inside = all_inside && error <= rule.well_inside * own;
  }
  // A few parts may exceed their share: with a 95 % band one in twenty does.
  const bool leave =
      static_cast<double>(out.outside) > rule.few * static_cast<double>(parts.size());
  if (leave && level + 1 < share.size()) {
    ++out.level;
  } else if (leave) {
    out.exhausted = true;
  } else if (all_inside && level > 0) {
    --out.level;
  }
  out.share = share[out.level];
  return out;
}

// The parts may come in any order; sorted by time, the model runs through the cyclogram once.
std::vector<Prediction> predict(const online::ThermalModel& model, const Cyclogram& cyclogram,
                                const std::vector<double>& ambient_c,
                                std::span<const double> time_s) {
  std::vector<std::size_t> order(time_s.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return time_s[i]; });
  std::vector<Prediction> out(time_s.size());
  const std::size_t modes = model.config().mode.size();
  const double start_mm = model.displacement_mm();
  const online::ThermalModel::State start = model.state();
  online::ThermalModel running = model;
  std::size_t at = 0;
  double begin_s = 0.0;
  for (const std::size_t k : order) {
    online::Drive drive;
    const auto drive_in = [&](std::size_t i) {
      drive = drive_of(cyclogram.transition[i]);
      drive.ambient_c.fill(std::numeric_limits<double>::quiet_NaN());
      std::ranges::copy(ambient_c, drive.ambient_c.begin());
    };
    while (at + 1 < cyclogram.transition.size() &&
           time_s[k] > begin_s + cyclogram.transition[at].seconds) {
      drive_in(at);
      running.update(cyclogram.transition[at].seconds, drive);
      begin_s += cyclogram.transition[at].seconds;
      ++at;
    }
    drive_in(at);
    // A copy for each instant: the running model stays at the transition's start.
    online::ThermalModel then = running;
    // Relative to the start of the work: the displacement at that time is in the workpiece's zero.
    out[k].displacement_mm = then.update(std::max(0.0, time_s[k] - begin_s), drive) - start_mm;
    for (std::size_t i = 0; i < modes; ++i) {
      out[k].mode_mm.push_back(then.state().mode_mm[i] - start.mode_mm[i]);
    }
  }
  return out;
}

Gains learn_gains(std::span<const Observation> observations, const GainRule& rule) {
  if (observations.empty()) {
    return {};
  }
  const std::size_t all = observations.size();
  const std::size_t at_once = std::max<std::size_t>(1, all / kRounds);
  std::vector<bool> left_out(all, false);
  std::vector<std::pair<double, std::size_t>> beyond;
  for (std::size_t gone = 0;;) {
    Pass pass(observations, rule);
    pass.run(left_out);
    beyond.clear();
    for (std::size_t k = 0; k < all; ++k) {
      const double left_mm = std::abs(pass.left_mm(k));
      // Early observations were judged when little was known; now that all are in, they are judged
      // again.
      if (!pass.out()[k] && left_mm > rule.gate_sd * rule.measuring_sd_mm) {
        beyond.emplace_back(-left_mm, k);
      }
    }
    // Where many would have to go, they are not the ones that are wrong.
    if (beyond.empty() || 10 * (gone + 1) > all) {
      return pass.gains();
    }
    const std::size_t worst = std::min(at_once, beyond.size());
    std::ranges::nth_element(beyond, beyond.begin() + static_cast<std::ptrdiff_t>(worst - 1));
    for (std::size_t i = 0; i < worst; ++i) {
      left_out[beyond[i].second] = true;
    }
    gone += worst;
  }
}

// A mode's gain scales everything that heats it, levels and feed alike, but not the surroundings.
void apply_gains(kernel::machine::ThermalAxis& axis, std::span<const double> gain) {
  std::vector<double> of_parameter;
  for (std::size_t i = 0; i < axis.mode.size(); ++i) {
    auto& mode = axis.mode[i];
    for (auto* levels : {&mode.level_mm, &mode.polynomial_mm}) {
      for (double& level : *levels) {
        level *= gain[i];
        of_parameter.push_back(gain[i]);
      }
    }
    mode.feed_s *= gain[i];
  }
  of_parameter.resize(axis.parameters(), 1.0);
  std::size_t entry = 0;
  for (std::size_t i = 0; i < of_parameter.size() && entry < axis.covariance.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      // Cov(g·a, h·b) = g·h·Cov(a, b).
      axis.covariance[entry++] *= of_parameter[i] * of_parameter[j];
    }
  }
}

}  // namespace steadyrest::thermal::offline
