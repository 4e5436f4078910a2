// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <steadyrest/motion/online/estimator/estimator.hpp>

/// Motion to and from standstill at constant jerk, as a control commands it.
///
/// To standstill: x(t) = x₀ − J·(t₀ − t)³/6 up to t₀, then rest; acceleration and speed vanish
/// together, v = a²/2J. Three unknowns, x₀, t₀ and J, are fitted to the last passages in one
/// direction by least squares, and the residual tells whether this is such a stop. From standstill:
/// x(t) = x₀ + J·(t − t₀)³/6 with J known, or learnt at the last stop. The first line gives the
/// instant for a way w, evenly distributed over 0 … 1 count (or known, if the previous stop gave
/// the axis' position); the absence of the next line bounds it from above; the second line
/// determines it, later ones verify.
///
/// Unit of length: the count. Limits: any other motion has share 0.
namespace steadyrest::motion::online {

class JerkRamp {
 public:
  struct Config {
    double jerk = kNoBound;  ///< limits, count/s³ …
    double acceleration = kNoBound;
    double speed = kNoBound;
    double clock_s = 0.0;  ///< period of the stamps
  };
  JerkRamp() = default;
  explicit JerkRamp(const Config& config) noexcept : config_(config), jerk_(config.jerk) {}

  /// A single line at x was passed. `variance` of its position, count²; `at_rest` is the
  /// probability that the axis was at rest before, and no line was passed for `quiet_s`.
  void edge(double t_s, double x, std::int8_t direction, double variance, double at_rest,
            double quiet_s) noexcept;
  /// Many lines at once, or a gap in the record: not the end of a stop.
  void forget() noexcept;

  /// Probability of this motion, and its velocity and acceleration.
  struct Motion {
    double share = 0.0;
    double v = 0.0;
    double a = 0.0;
  };
  /// At `when_s`, no later than `now_s`, with present knowledge.
  [[nodiscard]] Motion at(double now_s, double when_s) const noexcept {
    return kind_ == Kind::none || when_s < from_s_ ? Motion{}
           : kind_ == Kind::stop                   ? stopping(now_s, when_s)
                                                   : starting(now_s, when_s);
  }

 private:
  enum class Kind : std::uint8_t { none, stop, start };
  /// How often the prediction came true.
  struct Trust {
    double yes = 0.0;
    double all = 0.0;
    void learn(bool came) noexcept;
    [[nodiscard]] double share() const noexcept { return yes * yes / (all * all); }
  };
  struct Passage {
    double t_s = 0.0;
    double x = 0.0;
    double variance = 0.0;
  };
  /// x = x₀ − c·(t₀ − t)³ from the last passage in its direction.
  struct Curve {
    double x0 = 0.0;
    double t0_s = 0.0;
    double c = 0.0;
  };
  struct Residual {
    double value = 0.0;
    double variance = 0.0;
    double slope = 0.0;  ///< −∂x/∂t₀
    double cube = 0.0;   ///< −∂x/∂c
  };
  static constexpr std::size_t kPassages = 6;

  [[nodiscard]] const Passage& back(std::size_t age) const noexcept {
    return passages_[(next_ + kPassages - 1 - age) % kPassages];
  }
  [[nodiscard]] Motion stopping(double now_s, double when_s) const noexcept;
  [[nodiscard]] Motion starting(double now_s, double when_s) const noexcept;
  void begin(double t_s, double x, double at_rest) noexcept;
  void judge_stop(double t_s, double x, std::int8_t direction) noexcept;
  void go_on() noexcept;
  [[nodiscard]] bool guess(Curve& out) const noexcept;
  [[nodiscard]] Residual residual(std::size_t age, const Curve& curve) const noexcept;
  [[nodiscard]] bool improve(Curve& curve) const noexcept;
  void fit() noexcept;

  Config config_;
  double jerk_ = kNoBound;  ///< the limit, or what the last stop used
  std::array<Passage, kPassages> passages_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
  std::int8_t direction_ = 1;
  Kind kind_ = Kind::none;
  double share_ = 0.0;
  double from_s_ = 0.0;  ///< since when the motion is of this kind
  Trust stops_{1.0, 1.0};
  Trust starts_{1.55, 2.0};
  double x0_ = 0.0;      ///< position of standstill
  double t0_s_ = 0.0;    ///< when it begins or ends
  double c_ = 0.0;       ///< J/6
  bool known_ = false;   ///< a start whose t₀ is known
  bool judged_ = false;  ///< … and told from the line after
};

}  // namespace steadyrest::motion::online
