// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <steadyrest/motion/offline/scene/scene.hpp>

// Motions in closed form, and their records by an encoder and a clock. The truth at each tick comes
// from the formula itself; edges are found on it by bisection, so no integration error enters the
// comparison. Every random stream has its own seed: jitter does not change the lines.
namespace steadyrest::motion::offline {
namespace {

/// Positions of the lines that a motion may touch, including errors. Eight extra lines at either
/// end: rounding must not leave the table.
class Lines {
 public:
  Lines(const Recording& how, double low_mm, double high_mm)
      : count_mm_(how.count_mm),
        first_(static_cast<std::int64_t>(std::floor(low_mm / how.count_mm)) - 8) {
    const auto last = static_cast<std::int64_t>(std::ceil(high_mm / how.count_mm)) + 8;
    error_mm_.assign(static_cast<std::size_t>(last - first_ + 1), 0.0);
    std::mt19937_64 random(how.seed * 7919 + 1);
    std::normal_distribution<double> normal;
    // The four edges of one line pair: a pattern of zero mean and the given amplitude.
    constexpr std::array kPattern{0.6, -1.0, 0.9, -0.5};
    for (std::size_t i = 0; i < error_mm_.size(); ++i) {
      const auto phase = static_cast<std::size_t>((first_ + static_cast<std::int64_t>(i)) & 3);
      // More than 4 σ would swap neighbours on a bad encoder; no scale does that.
      const double single = std::clamp(normal(random), -4.0, 4.0) * how.line_error_counts;
      error_mm_[i] = count_mm_ * (kPattern[phase] * how.phase_error_counts + single);
    }
  }
  [[nodiscard]] double at(std::int64_t line) const {
    const std::int64_t i = line - first_;
    const bool inside = i >= 0 && i < static_cast<std::int64_t>(error_mm_.size());
    return static_cast<double>(line) * count_mm_ +
           (inside ? error_mm_[static_cast<std::size_t>(i)] : 0.0);
  }
  [[nodiscard]] std::int64_t first() const { return first_; }
  [[nodiscard]] const std::vector<double>& errors() const { return error_mm_; }
  // The floor is right except for the lines' errors; a step or two corrects it.
  [[nodiscard]] std::int64_t cell_of(double position_mm) const {
    auto cell = static_cast<std::int64_t>(std::floor(position_mm / count_mm_));
    while (position_mm < at(cell)) {
      --cell;
    }
    while (position_mm >= at(cell + 1)) {
      ++cell;
    }
    return cell;
  }

 private:
  double count_mm_;
  std::int64_t first_;
  std::vector<double> error_mm_;
};

/// The instant in [from, to] at which the position passes `level`; monotone in between.
/// Bisection to 10⁻¹³ s: with slopes near zero at a turn no faster method is safe.
double passage(const Profile& profile, double from, double to, double level) {
  const bool up = profile.at(to).position_mm > profile.at(from).position_mm;
  for (int i = 0; i < 60 && to - from > 1e-13; ++i) {
    const double middle = 0.5 * (from + to);
    const bool beyond =
        up ? profile.at(middle).position_mm >= level : profile.at(middle).position_mm < level;
    (beyond ? to : from) = middle;
  }
  return to;
}

class EdgeMaker {
 public:
  EdgeMaker(const Profile& profile, const Recording& how, const Lines& lines)
      : profile_(profile), how_(how), lines_(lines), random_(how.seed * 104729 + 3) {
    cell_ = lines.cell_of(profile.at(0.0).position_mm);
  }

  /// All passages in (from, to]; the step is short against the motion.
  /// Searches for a turn first: monotone parts pass each line once, and a line passed there and
  /// back within one step is not missed.
  void advance(double from, double to, std::vector<online::Edge>& out) {
    const double v0 = profile_.at(from).velocity_mm_s;
    const double v1 = profile_.at(to).velocity_mm_s;
    if (v0 * v1 < 0.0) {  // turns in between: the two branches are monotone
      double low = from;
      double high = to;
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (profile_.at(middle).velocity_mm_s * v0 > 0.0 ? low : high) = middle;
      }
      monotone(from, low, out);
      monotone(low, to, out);
      return;
    }
    monotone(from, to, out);
  }
  [[nodiscard]] std::int64_t cell() const { return cell_; }

 private:
  void monotone(double from, double to, std::vector<online::Edge>& out) {
    const double end = profile_.at(to).position_mm;
    while (end >= lines_.at(cell_ + 1)) {
      ++cell_;
      emit(passage(profile_, from, to, lines_.at(cell_)), cell_, 1, out);
    }
    while (end < lines_.at(cell_)) {
      emit(passage(profile_, from, to, lines_.at(cell_)), cell_, -1, out);
      --cell_;
    }
  }
  void emit(double t, std::int64_t line, std::int8_t direction, std::vector<online::Edge>& out) {
    if (how_.clock_s > 0.0) {
      // A latch truncates. The millionth keeps an instant at a whole tick from losing one.
      t = std::floor(t / how_.clock_s + 1e-6) * how_.clock_s;
    }
    if (how_.lost_share > 0.0 && share_(random_) < how_.lost_share) {
      // The edge is lost, but not the count: the next edge tells how many are missing, as counting
      // hardware does.
      lost_ = static_cast<std::uint8_t>(std::min(lost_ + 1, 255));
      return;
    }
    out.push_back({t, static_cast<double>(line) * how_.count_mm, line, direction,
                   static_cast<std::uint8_t>(lost_)});
    lost_ = 0;
  }

  const Profile& profile_;
  const Recording& how_;
  const Lines& lines_;
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> share_{0.0, 1.0};
  std::int64_t cell_ = 0;
  int lost_ = 0;
};

}  // namespace

// Limits of a sine: A·ω, A·ω², A·ω³.
Profile sine(double amplitude_mm, double frequency_hz, double duration_s) {
  const double w = 2.0 * std::numbers::pi * frequency_hz;
  Profile out;
  out.name = "sine";
  out.duration_s = duration_s;
  out.max_speed_mm_s = amplitude_mm * w;
  out.max_acceleration_mm_s2 = amplitude_mm * w * w;
  out.max_jerk_mm_s3 = amplitude_mm * w * w * w;
  out.at = [=](double t) {
    return MotionState{amplitude_mm * (1.0 - std::cos(w * t)), amplitude_mm * w * std::sin(w * t),
                       amplitude_mm * w * w * std::cos(w * t)};
  };
  return out;
}

// Constant jerk in each piece: position a cubic, evaluated from the knot at its start, so that
// errors do not add up along the motion. Limits are sampled, 100 points a piece; the extremes of a
// cubic's velocity lie at knots or where a = 0.
Profile jerk_pieces(const std::string& name, const MotionState& start,
                    const std::vector<JerkPiece>& pieces) {
  struct Knot {
    double t_s;
    MotionState state;
    double jerk;
  };
  const auto run = [](const Knot& knot, double t) {
    const double d = t - knot.t_s;
    const MotionState& s = knot.state;
    return MotionState{s.position_mm + d * (s.velocity_mm_s +
                                            d * (0.5 * s.acceleration_mm_s2 + d * knot.jerk / 6.0)),
                       s.velocity_mm_s + d * (s.acceleration_mm_s2 + 0.5 * d * knot.jerk),
                       s.acceleration_mm_s2 + d * knot.jerk};
  };
  std::vector<Knot> knots{{0.0, start, 0.0}};
  Profile out;
  out.name = name;
  double t = 0.0;
  for (const JerkPiece& piece : pieces) {
    knots.back().jerk = piece.jerk_mm_s3;
    out.max_jerk_mm_s3 = std::max(out.max_jerk_mm_s3, std::abs(piece.jerk_mm_s3));
    for (int i = 0; i <= 100; ++i) {
      const MotionState s = run(knots.back(), t + piece.duration_s * i / 100.0);
      out.max_speed_mm_s = std::max(out.max_speed_mm_s, std::abs(s.velocity_mm_s));
      out.max_acceleration_mm_s2 =
          std::max(out.max_acceleration_mm_s2, std::abs(s.acceleration_mm_s2));
    }
    t += piece.duration_s;
    MotionState end = run(knots.back(), t);
    // The rounding error of a stop would creep on forever.
    if (std::abs(end.velocity_mm_s) < 1e-9) {
      end.velocity_mm_s = 0.0;
    }
    if (std::abs(end.acceleration_mm_s2) < 1e-9) {
      end.acceleration_mm_s2 = 0.0;
    }
    knots.push_back({t, end, 0.0});
  }
  out.duration_s = t;
  out.at = [knots, run](double time) {
    const auto after =
        std::upper_bound(knots.begin() + 1, knots.end(), time,
                         [](double value, const Knot& knot) { return value < knot.t_s; });
    return run(*(after - 1), time);
  };
  return out;
}

// Jerk up, hold at the limit of acceleration, jerk down. Without a hold the change is J·t² for two
// ramps of t, so t = √(Δv/J).
std::vector<JerkPiece> speed_change(double change_mm_s, double max_acceleration_mm_s2,
                                    double max_jerk_mm_s3) {
  const double change = std::abs(change_mm_s);
  const double jerk = std::copysign(max_jerk_mm_s3, change_mm_s);
  // Either the acceleration reaches its limit, or the change ends first, without a hold.
  const double ramp_s =
      std::min(max_acceleration_mm_s2 / max_jerk_mm_s3, std::sqrt(change / max_jerk_mm_s3));
  const double reached = max_jerk_mm_s3 * ramp_s;
  const double hold_s = std::max(0.0, change / reached - ramp_s);
  return {{ramp_s, jerk}, {hold_s, 0.0}, {ramp_s, -jerk}};
}

// Rest, 20 mm/s, stop, back at 2 mm/s, stop: fast and slow motion, starts, stops and a reversal in
// one.
Profile s_curve() {
  constexpr double kAcceleration_mm_s2 = 200.0;
  constexpr double kJerk_mm_s3 = 5000.0;
  std::vector<JerkPiece> pieces{{0.1, 0.0}};
  const auto add = [&](double change, double hold_s) {
    const std::vector<JerkPiece> ramp = speed_change(change, kAcceleration_mm_s2, kJerk_mm_s3);
    pieces.insert(pieces.end(), ramp.begin(), ramp.end());
    pieces.push_back({hold_s, 0.0});
  };
  add(20.0, 0.4);
  add(-20.0, 0.1);
  add(-2.0, 0.5);
  add(2.0, 0.1);
  Profile out = jerk_pieces("s-curve", {0.0003, 0.0, 0.0}, pieces);
  return out;
}

// The paper's figure 2: a flywheel evenly braked by friction. The jerk at the start of braking is
// infinite; the limit is what an estimator may be given.
Profile flywheel(double counts_per_tick, double counts_per_tick2) {
  const double v0 = counts_per_tick;        // 1 count/tick = 1 mm/s
  const double a = counts_per_tick2 * 1e3;  // 1 count/tick² = 1000 mm/s²
  const double stop_s = -v0 / a;
  constexpr double kRunIn = 0.04;
  Profile out = jerk_pieces("flywheel", {0.00037, v0, 0.0}, {{kRunIn, 0.0}});
  out.duration_s = kRunIn + stop_s;
  out.max_speed_mm_s = v0;
  out.max_acceleration_mm_s2 = -a;
  out.max_jerk_mm_s3 = 100.0;
  out.at = [=](double t) {
    const double d = std::max(0.0, t - kRunIn);
    const bool braking = t >= kRunIn;
    return MotionState{0.00037 + v0 * t + 0.5 * a * d * d, v0 + a * d, braking ? a : 0.0};
  };
  return out;
}

Profile constant_speed(double speed_mm_s, double duration_s) {
  return jerk_pieces("constant", {0.00021, speed_mm_s, 0.0}, {{duration_s, 0.0}});
}

// Shifted so that the motion goes back and forth over one line near its turning point.
Profile dither(double amplitude_mm, double frequency_hz, double duration_s) {
  Profile out = sine(amplitude_mm, frequency_hz, duration_s);
  const auto inner = out.at;
  out.name = "dither";
  out.at = [inner, amplitude_mm](double t) {
    MotionState s = inner(t);
    s.position_mm -= 0.9 * amplitude_mm;
    return s;
  };
  return out;
}

Record record(const Profile& profile, const Recording& how) {
  double low = profile.at(0.0).position_mm;
  double high = low;
  const double step_s = std::min(1e-4, 0.1 / how.cycle_hz);
  // The extremes are only needed to the width of a few lines.
  for (double t = 0.0; t <= profile.duration_s; t += step_s) {
    const double x = profile.at(t).position_mm;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  const Lines lines(how, low, high);
  EdgeMaker maker(profile, how, lines);
  std::mt19937_64 random(how.seed * 15485863 + 5);
  std::normal_distribution<double> normal;
  Record out;
  out.name = profile.name;
  out.how = how;
  out.max_speed_mm_s = profile.max_speed_mm_s;
  out.max_acceleration_mm_s2 = profile.max_acceleration_mm_s2;
  out.max_jerk_mm_s3 = profile.max_jerk_mm_s3;
  out.first_line = lines.first();
  out.line_error_mm = lines.errors();
  double t = 0.0;
  const auto ticks = static_cast<std::size_t>(std::floor(profile.duration_s * how.cycle_hz + 1e-9));
  for (std::size_t k = 0; k <= ticks; ++k) {
    const double nominal = static_cast<double>(k) / how.cycle_hz;
    // Less than half a cycle, or ticks would swap places.
    const double jitter =
        std::clamp(normal(random) * how.tick_jitter_s, -0.4 / how.cycle_hz, 0.4 / how.cycle_hz);
    const double look = std::clamp(nominal + jitter, 0.0, profile.duration_s);
    while (t < look) {
      const double next = std::min(look, t + step_s);
      maker.advance(t, next, out.edges);
      t = next;
    }
    const auto cell = static_cast<double>(maker.cell());
    out.ticks.push_back({look, maker.cell(), cell * how.count_mm, (cell + 1.0) * how.count_mm});
    out.truth.push_back(profile.at(look));
  }
  return out;
}

}  // namespace steadyrest::motion::offline
