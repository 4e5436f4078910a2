// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/sim/axis/edge_search.hpp>

// x(t) is the cubic through both ends' positions and velocities; a reversal divides it, so that
// each part passes a border at most once. Secants then find the instant, kept inside a bracket.
namespace steadyrest::sim {
namespace {

constexpr int kMostRounds = 60;
constexpr int kSecants = 10;
constexpr double kPrecision = 1e-8;  ///< counts

/// x(u) with u = t/h, from the end: large values cancel before they are multiplied.
class Cubic {
 public:
  explicit Cubic(const Stretch& s) noexcept
      : end_mm_(s.end_mm),
        slope_mm_(s.end_mm_s * s.duration_s),
        start_slope_mm_(s.start_mm_s * s.duration_s),
        chord_mm_(s.end_mm - s.start_mm) {}

  /// w = 1 − u: the way back from the end.
  [[nodiscard]] double at(double w) const noexcept {
    const double u = 1.0 - w;
    const double bend = w * (start_slope_mm_ - chord_mm_) - u * (slope_mm_ - chord_mm_);
    return end_mm_ - w * (chord_mm_ - u * bend);
  }
  [[nodiscard]] double slope(double w) const noexcept {
    const double u = 1.0 - w;
    const double d0 = start_slope_mm_ - chord_mm_;
    const double d1 = slope_mm_ - chord_mm_;
    return chord_mm_ + (w - u) * (w * d0 - u * d1) - u * w * (d0 + d1);
  }
  /// Where the velocity changes sign, when the signs at both ends differ. Bisection: the slope is a
  /// parabola in w with different signs at the ends, so one root lies between.
  [[nodiscard]] double turn() const noexcept {
    double low = 0.0;
    double high = 1.0;
    const bool rises = slope_mm_ > 0.0;
    for (int i = 0; i < kMostRounds && high - low > 1e-12; ++i) {
      const double middle = 0.5 * (low + high);
      ((slope(middle) > 0.0) == rises ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

 private:
  double end_mm_;
  double slope_mm_;
  double start_slope_mm_;
  double chord_mm_;
};

/// The reading crosses `border_mm` between w = `late` and w = `early`: secants, the first with the
/// slope of the motion alone; bisection where one leaves the bracket or takes too long.
double crossing(const Encoder& encoder, const Cubic& x, double late, double early, double border_mm,
                bool up) noexcept {
  const double tolerance_mm = kPrecision * encoder.count_mm() + 1e-15 * std::abs(border_mm);
  double w = late;
  double f = encoder.reading(x.at(w)) - border_mm;
  double slope = -x.slope(w);
  for (int i = 0; i < kMostRounds && std::abs(f) > tolerance_mm; ++i) {
    ((f > 0.0) == up ? late : early) = w;
    const double last = w;
    w -= f / slope;
    const bool inside = w > late && w < early;
    if (!inside || i > kSecants) {
      w = 0.5 * (late + early);
    }
    const double f_last = f;
    f = encoder.reading(x.at(w)) - border_mm;
    slope = (f - f_last) / (w - last);
  }
  return w;
}

/// On a stretch without reversal, with the counter at `after` at its late end.
std::optional<Passage> between(const Encoder& encoder, const Cubic& x, double late, double early,
                               double duration_s, std::int64_t after) noexcept {
  const double moved_mm = x.at(late) - x.at(early);
  // A part that moved further than the encoder can hide has an edge in its own direction; a shorter
  // one has it only if the count differs.
  bool up = moved_mm > 0.0;
  if (std::abs(moved_mm) <= encoder.surely_mm()) {
    const std::int64_t before = encoder.count(x.at(early));
    if (after == before) {
      return std::nullopt;
    }
    up = after > before;
  }
  const double border_mm = (static_cast<double>(after) + (up ? -0.5 : 0.5)) * encoder.count_mm();
  return Passage{.before_end_s = crossing(encoder, x, late, early, border_mm, up) * duration_s,
                 .direction = static_cast<std::int8_t>(up ? 1 : -1)};
}

}  // namespace

std::optional<Passage> last_passage(const Encoder& encoder, const Stretch& stretch,
                                    std::int64_t count_at_end) noexcept {
  const Cubic x(stretch);
  if (stretch.start_mm_s * stretch.end_mm_s >= 0.0) {
    return between(encoder, x, 0.0, 1.0, stretch.duration_s, count_at_end);
  }
  const double turn = x.turn();
  // From the end backwards: the later part first, since its edge is the last.
  const auto after = between(encoder, x, 0.0, turn, stretch.duration_s, count_at_end);
  return after ? after : between(encoder, x, turn, 1.0, stretch.duration_s, count_at_end);
}

}  // namespace steadyrest::sim
