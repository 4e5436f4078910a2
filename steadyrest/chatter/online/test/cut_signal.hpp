// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <steadyrest/chatter/online/speed_law.hpp>

/// A small time-domain simulation of milling, independent of the project's own: one mode in x and
/// one in y, straight teeth; each tooth meets the surface left by the previous five and may leave
/// the cut. Fixed step, forces held over a step.
namespace steadyrest::chatter::online::test {

struct CutModel {
  std::array<double, 2> frequency_hz{922.0, 1010.0};
  std::array<double, 2> damping_ratio{0.011, 0.02};
  std::array<double, 2> stiffness_n_mm{1340.0, 2000.0};
  std::size_t teeth = 2;
  double immersion = 1.0;
  bool up = true;
  double depth_mm = 0.5;
  double tangential_n_mm2 = 600.0, radial_n_mm2 = 200.0;
  double feed_mm = 0.08;
  double runout_mm = 0.0;  ///< of the first tooth
  double speed_rev_s = 5000.0 / 60.0;
  Law law = Law::constant;
  double rva = 0.0, rvf = 0.1;
  bool regenerates = true;  ///< false: only forced vibration
  bool accelerometer = false;
  double air_s = 0.0;      ///< before the cutter enters
  double kick_mm_s = 0.0;  ///< speed in x and y as it enters
};

struct CutSignal {
  double rate_hz = 10e3;
  std::vector<double> value, speed_rev_s, angle_rev;
};

class CutSimulation {
 public:
  CutSimulation(const CutModel& model, double seconds, double rate_hz)
      : m_(model),
        h_(1.0 / (rate_hz * kFine)),
        steps_(static_cast<std::size_t>(seconds * rate_hz) * kFine),
        entry_step_(static_cast<std::size_t>(m_.air_s * rate_hz) * kFine),
        angle_(steps_),
        q_{std::vector<double>(steps_), std::vector<double>(steps_)},
        out_{.rate_hz = rate_hz, .value = {}, .speed_rev_s = {}, .angle_rev = {}} {}

  CutSignal run() {
    const SpeedLaw law(m_.law);
    for (std::size_t i = 0; i < steps_; ++i) {
      const double speed = m_.speed_rev_s * (1.0 + m_.rva * law.at(m_.rvf * theta_));
      angle_[i] = theta_;
      q_[0][i] = x_[0];
      q_[1][i] = x_[1];
      const Surfaces old = look_back(i);
      if (i == entry_step_) {
        v_ = {m_.kick_mm_s, m_.kick_mm_s};
      }
      const double acceleration = vibrate(force(i, old));
      if (i % kFine == 0) {
        out_.value.push_back(m_.accelerometer ? acceleration : q_[0][i]);
        out_.speed_rev_s.push_back(speed);
        out_.angle_rev.push_back(theta_);
      }
      theta_ += speed * h_;
    }
    return std::move(out_);
  }

 private:
  static constexpr std::size_t kFine = 4;
  static constexpr std::size_t kPasses = 5;
  static constexpr double kTurn = 2.0 * std::numbers::pi;
  using Pair = std::array<double, 2>;
  using Surfaces = std::array<Pair, kPasses>;

  /// Where the tool was when the previous teeth passed.
  Surfaces look_back(std::size_t i) {
    const double pitch = 1.0 / static_cast<double>(m_.teeth);
    Surfaces old{};
    for (std::size_t p = 0; p < kPasses; ++p) {
      const double at = theta_ - pitch * static_cast<double>(p + 1);
      while (back_[p] + 1 < i && angle_[back_[p] + 1] <= at) {
        ++back_[p];
      }
      const std::size_t b = back_[p];
      if (at > 0.0 && b + 1 <= i) {
        const double share = (at - angle_[b]) / (angle_[b + 1] - angle_[b]);
        old[p] = {q_[0][b] + share * (q_[0][b + 1] - q_[0][b]),
                  q_[1][b] + share * (q_[1][b + 1] - q_[1][b])};
      }
    }
    return old;
  }

  /// Thickness of the chip of tooth j; 0 where it is out of the cut.
  [[nodiscard]] double chip_mm(std::size_t j, double s, double c, const Surfaces& old) const {
    const double radius = j == 0 ? m_.runout_mm : 0.0;
    const double before = j + 1 == m_.teeth ? m_.runout_mm : 0.0;  // the tooth in front
    double chip = m_.feed_mm * s + (m_.teeth > 1 ? radius - before : 0.0);
    if (m_.regenerates) {
      const double now = x_[0] * s + x_[1] * c;
      double least = 1e9;
      for (std::size_t p = 0; p < kPasses; ++p) {
        least = std::min(
            least, static_cast<double>(p) * m_.feed_mm * s + now - (old[p][0] * s + old[p][1] * c));
      }
      chip += least;
    }
    return std::max(chip, 0.0);
  }

  [[nodiscard]] Pair force(std::size_t i, const Surfaces& old) const {
    const double entry = m_.up ? 0.0 : std::acos(2.0 * m_.immersion - 1.0);
    const double exit = m_.up ? std::acos(1.0 - 2.0 * m_.immersion) : std::numbers::pi;
    const double pitch = 1.0 / static_cast<double>(m_.teeth);
    Pair force{};
    for (std::size_t j = 0; j < m_.teeth; ++j) {
      const double turns = theta_ + pitch * static_cast<double>(j);
      const double phi = kTurn * (turns - std::floor(turns));
      if (i < entry_step_ || phi < entry || phi > exit) {
        continue;
      }
      const double s = std::sin(phi);
      const double c = std::cos(phi);
      const double chip = chip_mm(j, s, c, old);
      const double t = m_.tangential_n_mm2 * m_.depth_mm * chip;
      const double r = m_.radial_n_mm2 * m_.depth_mm * chip;
      force[0] += -t * c - r * s;
      force[1] += t * s - r * c;
    }
    return force;
  }

  /// One step of both modes under the force; the acceleration in x at its start.
  double vibrate(const Pair& force) {
    double acceleration = 0.0;
    for (std::size_t d = 0; d < 2; ++d) {
      const double w = kTurn * m_.frequency_hz[d];
      const double z = m_.damping_ratio[d];
      const double wd = w * std::sqrt(1.0 - z * z);
      const double rest = force[d] / m_.stiffness_n_mm[d];
      if (d == 0) {
        acceleration = w * w * (rest - x_[0]) - 2.0 * z * w * v_[0];
      }
      const double e = std::exp(-z * w * h_);
      const double co = std::cos(wd * h_);
      const double si = std::sin(wd * h_);
      const double a = x_[d] - rest;
      const double b = (v_[d] + z * w * a) / wd;
      x_[d] = rest + e * (a * co + b * si);
      v_[d] = e * (wd * (b * co - a * si) - z * w * (a * co + b * si));
    }
    return acceleration;
  }

  CutModel m_;
  double h_;
  std::size_t steps_;
  std::size_t entry_step_;
  std::vector<double> angle_;
  std::array<std::vector<double>, 2> q_;
  Pair x_{}, v_{};
  std::array<std::size_t, kPasses> back_{};
  double theta_ = 0.0;
  CutSignal out_;
};

inline CutSignal simulate(const CutModel& m, double seconds, double rate_hz = 10e3) {
  return CutSimulation(m, seconds, rate_hz).run();
}

/// RMS about the mean from `first` on.
inline double rms(const std::vector<double>& x, std::size_t first = 0) {
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = first; i < x.size(); ++i) {
    sum += x[i];
    squares += x[i] * x[i];
  }
  const auto n = static_cast<double>(x.size() - first);
  return std::sqrt(std::max(squares / n - sum * sum / (n * n), 0.0));
}

/// The truth about a signal, from further simulations.
struct Truth {
  bool chatters = false;     ///< another start gives another vibration
  bool stable = false;       ///< another start gives the same vibration
  double onset_s = 0.0;      ///< regeneration's part first reaches a tenth of its final size
  double added_ratio = 0.0;  ///< RMS of regeneration's part, over forced_rms
  double forced_rms = 0.0;   ///< of the vibration without regeneration
};

inline Truth truth_of(const CutModel& model, const CutSignal& signal) {
  const auto n = signal.value.size();
  const double seconds = static_cast<double>(n) / signal.rate_hz;
  CutModel forced = model;
  forced.regenerates = false;
  const CutSignal alone = simulate(forced, seconds, signal.rate_hz);
  CutModel kicked = model;
  kicked.kick_mm_s = 30.0;
  const CutSignal other = simulate(kicked, seconds, signal.rate_hz);
  std::vector<double> added(n);
  std::vector<double> apart(n);
  double size = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    added[i] = std::abs(signal.value[i] - alone.value[i]);
    apart[i] = signal.value[i] - other.value[i];
    size = i >= 3 * n / 4 ? std::max(size, added[i]) : size;
  }
  Truth out;
  const double all = rms(signal.value, 3 * n / 4);
  const double rest = rms(apart, 3 * n / 4);
  out.forced_rms = rms(alone.value, n / 2);
  out.chatters = rest > 0.3 * all && all < 100.0 * out.forced_rms;
  for (std::size_t i = 0; i < n; ++i) {
    apart[i] = signal.value[i] - alone.value[i];
  }
  out.added_ratio = rms(apart, n / 4) / out.forced_rms;
  out.stable = rest < 1e-3 * all && out.added_ratio < 0.5;
  const auto it = std::ranges::find_if(added, [&](double a) { return a > 0.1 * size; });
  out.onset_s = static_cast<double>(it - added.begin()) / signal.rate_hz;
  return out;
}

/// A random cut: mode, cutter, immersion, speed, depth.
inline CutModel random_cut(std::mt19937_64& rng, bool modulated) {
  const auto draw = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(rng);
  };
  CutModel m;
  m.teeth = static_cast<std::size_t>(draw(2.0, 6.0));
  m.frequency_hz = {draw(400.0, 1500.0), draw(400.0, 1500.0)};
  m.damping_ratio = {draw(0.01, 0.04), draw(0.01, 0.04)};
  m.stiffness_n_mm = {draw(1e3, 1e4), draw(1e3, 1e4)};
  m.immersion = draw(0.1, 1.0);
  m.up = draw(0.0, 1.0) < 0.5;
  m.speed_rev_s = draw(3000.0, 12000.0) / 60.0;
  m.runout_mm = draw(0.0, 1.0) < 0.5 ? 0.0 : draw(0.0, 0.01);
  const double soft = m.damping_ratio[0] * m.stiffness_n_mm[0];
  m.depth_mm = soft / 200.0 * std::exp(draw(-1.5, 2.5));
  m.accelerometer = draw(0.0, 1.0) < 0.5;
  if (modulated) {
    constexpr std::array kModulated{Law::sine, Law::triangle, Law::square};
    m.law = kModulated[static_cast<std::size_t>(draw(0.0, 3.0))];
    m.rva = draw(0.05, 0.2);
    m.rvf = draw(0.02, 0.2);
  }
  return m;
}

}  // namespace steadyrest::chatter::online::test
