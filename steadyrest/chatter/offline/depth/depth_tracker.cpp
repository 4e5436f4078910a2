// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <steadyrest/chatter/offline/cycle/modal_answers.hpp>
#include <steadyrest/chatter/offline/cycle/multipliers.hpp>
#include <steadyrest/chatter/offline/depth/crossing.hpp>
#include <steadyrest/chatter/offline/depth/depth_tracker.hpp>

// dominant(): 1. follow() carries every known zero from the last depth to this one, 2. verified()
// counts the zeros of g inside a circle about the dominant one, 3. if the count is off, search()
// looks for the missing zero with the known ones divided out, 4. if that fails, Arnoldi's method
// starts over. Steps 1 and 2 do for nearly every depth; the count tells when a zero is missing.
namespace steadyrest::chatter::offline {
namespace {

using Complex = std::complex<double>;

constexpr double kFollowed = 1.35;  ///< zeros farther out over the nearest are left
constexpr double kSameZero = 1e-7;  ///< two zeros are one, relative
constexpr double kLastStep = 1e-5;  ///< relative; the error left is far smaller
constexpr double kNudge = 1e-3;     ///< for derivatives, relative
constexpr double kLeastNudge = 1e-5;
constexpr double kRealZero = 1e-7;  ///< |Im ξ| of a real zero, relative
constexpr int kMostHalleySteps = 9;
constexpr std::size_t kMostRoots = 5;
constexpr std::size_t kSeeds = 6;
constexpr std::size_t kStarts = 9;
constexpr double kOutside = 1.12;  ///< radius of the counting circle over the zero within
constexpr double kBetween = 1.03;  ///< a zero nearer to the circle than this is taken inside
/// Points on the half circle of a count, a multiple of the lanes; more where zeros crowd.
constexpr std::size_t kArc = 16;
constexpr std::size_t kMostArc = 512;
constexpr int kMostHalvings = 7;

/// One of a conjugate pair; a real zero exactly real.
Complex upper(Complex xi) {
  return std::abs(xi.imag()) < kRealZero * std::abs(xi) ? Complex(xi.real())
         : xi.imag() < 0.0                              ? std::conj(xi)
                                                        : xi;
}

int quadrant(Complex g) {
  if (g.imag() >= 0.0) {
    return g.real() > 0.0 ? 0 : g.imag() > 0.0 ? 1 : 2;
  }
  return g.real() < 0.0 ? 2 : 3;
}

/// The half circle, ξ = 1 … −1, on which zeros are counted.
// Of the order of ζ·(waves between two teeth) multipliers of each mode are about as large as the
// dominant one and crowd in one sector; between points too far apart g turns several times unseen.
// 1008 turned cuts (ζ = 0.02 … 0.99, 1 … 50 waves, digging in or not, 0.5 … 5 times the safe
// depth), points that were wrong: 42 with 16 on the half circle, from ζ·waves = 2.5 up; 13 with 32,
// from 10 up; 3 with 64, from 15 up; none with 128. So many for each 0.5 leave a factor of 2 and
// more.
std::vector<Complex> half_circle(const Process& process, double speed_rev_s) {
  double crowd = 0.0;
  for (const Mode& mode : process.modes) {
    const double waves =
        mode.frequency_hz / (static_cast<double>(process.tool.teeth) * speed_rev_s);
    crowd += mode.damping_ratio * waves;
  }
  const double wanted = static_cast<double>(kArc) * (1.0 + std::floor(2.0 * crowd));
  const auto count = static_cast<std::size_t>(std::min(wanted, static_cast<double>(kMostArc)));
  std::vector<Complex> unit(count);
  for (std::size_t k = 0; k < count; ++k) {
    unit[k] =
        std::polar(1.0, std::numbers::pi * static_cast<double>(k) / static_cast<double>(count - 1));
  }
  return unit;
}

}  // namespace

DepthTracker::DepthTracker(Process process, double speed_rev_s, double most_depth_mm)
    : process_(std::move(process)),
      speed_rev_s_(speed_rev_s),
      most_depth_mm_(most_depth_mm),
      each_depth_(process_.tool.helix_rad != 0.0 && process_.cut.operation == Operation::milling),
      half_circle_(half_circle(process_, speed_rev_s)),
      on_circle_(half_circle_.size()),
      values_(half_circle_.size()) {
  const double pass_s = 1.0 / (static_cast<double>(process_.tool.teeth) * speed_rev_s_);
  for (const Complex& mu : free_multipliers(process_, pass_s)) {
    free_log_radius_ = std::max(free_log_radius_, std::log(std::abs(mu)));
    // At depth 0 nothing is cut: the multipliers are those of the free vibration, known in closed
    // form, and every root starts there.
    if (std::abs(mu) * kMostXi > 1.0) {
      roots_.push_back({upper(1.0 / mu), 0.0});
    }
  }
  sort();
}

void DepthTracker::sort() {
  std::ranges::sort(roots_, {}, [](const Root& r) { return std::abs(r.xi); });
  // Two that were followed separately may have landed on one zero; counted twice, it would spoil
  // the count in verified().
  const auto same = [](const Root& a, const Root& b) {
    return std::abs(a.xi - b.xi) < kSameZero * std::abs(a.xi);
  };
  roots_.erase(std::unique(roots_.begin(), roots_.end(), same), roots_.end());
  // Zeros far outside cannot become dominant within the next step and only cost evaluations;
  // verified() finds them if they come near.
  const double most =
      roots_.empty() ? kMostXi : std::min(kMostXi, kFollowed * std::abs(roots_[0].xi));
  std::erase_if(roots_, [most](const Root& r) { return std::abs(r.xi) > most; });
  if (roots_.size() > kMostRoots) {
    roots_.resize(kMostRoots);
  }
}

/// Halley's steps, the derivatives from neighbours on either side; empty: they lead nowhere.
std::optional<Complex> DepthTracker::refine(Complex start, double depth_mm,
                                            std::span<const Complex> but) {
  Complex x = start;
  double h = kNudge * std::abs(start);
  for (int i = 0; i < kMostHalleySteps; ++i) {
    PassMatrix::Lanes at;
    // The fourth lane is idle; four cost little more than three.
    const PassMatrix::Lanes xi{x, x + h, x - h, x};
    g(xi, depth_mm, at);
    for (const Complex& zero : but) {
      for (std::size_t k = 0; k < 3; ++k) {
        // Divided out with its conjugate: g is real on the real axis, so zeros come in pairs.
        at[k] /= zero.imag() == 0.0 ? xi[k] - zero : (xi[k] - zero) * (xi[k] - std::conj(zero));
      }
    }
    const Complex slope = (at[1] - at[2]) / (2.0 * h);
    const Complex bend = (at[1] - 2.0 * at[0] + at[2]) / (h * h);
    // Halley: x − 2·g·g′/(2·g′² − g·g″).
    const Complex below = 2.0 * slope * slope - at[0] * bend;
    if (below == 0.0) {
      return at[0] == 0.0 ? std::optional<Complex>(x) : std::nullopt;
    }
    const Complex step = 2.0 * at[0] * slope * std::conj(below) / std::norm(below);
    x -= step;
    const double size = std::sqrt(std::norm(x));
    const double moved = std::sqrt(std::norm(step));
    // Also catches NaN. Beyond, the matrices were not made for such z.
    if (!(size < 2.0 * kMostXi)) {
      return std::nullopt;
    }
    // What is left is about the cube of the step, and its product with the error of the slope.
    if (moved < kLastStep * size) {
      return x;
    }
    // Differences over less than the last step; too small a h would drown in the rounding of g.
    h = std::clamp(0.3 * moved, kLeastNudge * size, kNudge * size);
  }
  return std::nullopt;
}

/// False: it could not be followed.
bool DepthTracker::follow(Root& root, double from_mm, double to_mm) {
  double at = from_mm;
  double step = to_mm - from_mm;
  // A step that is not trusted is halved, one that is lets the next be twice as long.
  for (int tries = 0; tries < 40; ++tries) {
    // First-order prediction along the depth, then correction: a pair of zeros that crosses others
    // keeps its identity.
    const Complex guess = root.xi + root.slope * step;
    const auto next = refine(guess, at + step);
    // A step that is far from what was foretold may have landed on a neighbour.
    const double moved = next ? std::abs(*next - guess) : 1.0;
    if (!next || moved > 0.05 * std::abs(root.xi) + 0.5 * std::abs(root.slope * step)) {
      step *= 0.5;
      if (std::abs(step) < 1e-3 * std::abs(to_mm - from_mm)) {
        return false;
      }
      continue;
    }
    root.slope = (*next - root.xi) / step;
    root.xi = *next;
    at += step;
    if (std::abs(at - to_mm) <= 1e-12 * most_depth_mm_) {
      root.xi = upper(root.xi);
      // A pair that met on the real axis goes on as real zeros; a complex slope would lead it off.
      if (root.xi.imag() == 0.0) {
        root.slope = root.slope.real();
      }
      return true;
    }
    step = std::min(2.0 * step, to_mm - at);
  }
  return false;
}

/// Number of zeros of g with |ξ| < radius; empty: the circle passes too near to one. The argument
/// principle: g is entire, so on the circle its argument turns by 2π for each zero inside. g is
/// real on the real axis, so half of the circle is enough.
std::optional<int> DepthTracker::zeros_within(double radius, double depth_mm) {
  struct Point {
    Complex unit;
    Complex g;
  };
  for (std::size_t k = 0; k < half_circle_.size(); ++k) {
    on_circle_[k] = radius * half_circle_[k];
  }
  g(on_circle_, depth_mm, values_);
  // Real where ξ is.
  values_.front() = values_.front().real();
  values_.back() = values_.back().real();
  int quarters = 0;
  Point last{half_circle_[0], values_[0]};
  for (std::size_t k = 1; k < half_circle_.size(); ++k) {
    std::array<Point, kMostHalvings + 1> ahead{};
    std::size_t depth = 0;
    ahead[0] = {half_circle_[k], values_[k]};
    while (true) {
      const Point& next = ahead[depth];
      // Two points whose g are less than 90° apart (positive inner product) cannot hide a turn
      // between them; otherwise the arc is halved.
      // Less than a quarter turn: then the quadrants tell how many of them there are in all.
      if (next.g.real() * last.g.real() + next.g.imag() * last.g.imag() > 0.0) {
        const int step = quadrant(next.g) - quadrant(last.g);
        quarters += step == 3 ? -1 : step == -3 ? 1 : step;
        last = next;
        if (depth == 0) {
          break;
        }
        --depth;
        continue;
      }
      if (depth + 1 == ahead.size()) {
        return std::nullopt;
      }
      Complex between = last.unit + next.unit;
      // The middle of an arc less than a half turn long.
      between /= std::sqrt(std::norm(between));
      const Complex at = radius * between;
      PassMatrix::Lanes there;
      g(PassMatrix::Lanes{at, at, at, at}, depth_mm, there);
      ahead[++depth] = {between, there[0]};
    }
  }
  // Quarter turns over the half circle, twice as many over the whole, four of them for each zero.
  return quarters / 2;
}

/// All zeros within a circle that leaves the dominant one well inside are among those followed.
bool DepthTracker::verified(double depth_mm) {
  if (roots_.empty()) {
    return false;
  }
  const double dominant = std::abs(roots_[0].xi);
  // The circle must pass between zeros: those just outside are taken in, and before the first gap
  // it stops halfway.
  double radius = kOutside * dominant;
  int expected = 0;
  for (const Root& root : roots_) {
    const double size = std::abs(root.xi);
    if (size < kBetween * radius) {
      expected += root.xi.imag() == 0.0 ? 1 : 2;
      radius = std::max(radius, kOutside * size);
    } else {
      radius = std::min(radius, std::sqrt(size * radius));
      break;
    }
  }
  const auto inside = zeros_within(radius, depth_mm);
  return inside.has_value() && *inside == expected;
}

/// Looks for zeros that have come near from outside, those that are known divided out, until none
/// is missing.
bool DepthTracker::search(double depth_mm) {
  // A zero that has come near from outside is about as far out as the dominant one: the search
  // starts on a half circle of that size.
  const double radius = roots_.empty() ? 1.0 : std::abs(roots_[0].xi);
  std::vector<Complex> known;
  known.reserve(roots_.size() + kStarts);
  for (const Root& root : roots_) {
    known.push_back(root.xi);
  }
  for (std::size_t k = 0; k < kStarts; ++k) {
    const double angle =
        std::numbers::pi * static_cast<double>(k) / static_cast<double>(kStarts - 1);
    const auto near = refine(std::polar(radius, angle), depth_mm, known);
    // Once more on g itself: dividing known zeros out shifts what is found by their errors.
    const auto xi = near ? refine(*near, depth_mm) : std::nullopt;
    const bool is_known = !xi || std::ranges::any_of(known, [&](const Complex& other) {
      return std::abs(other - upper(*xi)) < kSameZero * std::abs(other);
    });
    if (is_known) {
      continue;
    }
    known.push_back(upper(*xi));
    roots_.push_back({known.back(), 0.0});
    sort();
    if (verified(depth_mm)) {
      return true;
    }
  }
  return false;
}

Complex DepthTracker::by_arnoldi(double depth_mm) {
  ++helped_;
  seed(depth_mm);
  const Multipliers found = multipliers(*cycle_, kSeeds, 1e-9);
  std::vector<Root> now;
  for (const Complex& mu : found.value) {
    if (mu.imag() < 0.0 || std::abs(mu) * kMostXi < 1.0) {
      continue;
    }
    const Complex xi = upper(1.0 / mu);
    const auto exact = refine(xi, depth_mm);
    // Arnoldi's value is good to 1e-9 or was cut short; refined it is only trusted while it stays
    // at the same zero.
    now.push_back({exact && std::abs(*exact - xi) < 1e-3 * std::abs(xi) ? upper(*exact) : xi, 0.0});
  }
  roots_ = std::move(now);
  sort();
  depth_mm_ = depth_mm;
  const Complex mu = found.value[0];
  // Every multiplier below 1/kMostXi: the cut is stable by far, and Arnoldi's value does.
  return roots_.empty() ? Complex(mu.real(), std::abs(mu.imag())) : std::conj(1.0 / roots_[0].xi);
}

void DepthTracker::seed(double depth_mm) {
  if (!cycle_ || each_depth_) {
    DelayCycle::Config config;
    config.speed_rev_s = speed_rev_s_;
    config.most_depth_mm = each_depth_ ? depth_mm : most_depth_mm_;
    auto made = DelayCycle::make(process_, config);
    cycle_ = std::make_unique<DelayCycle>(std::move(made.value()));
  }
  cycle_->set_depth(depth_mm);
}

Complex DepthTracker::dominant(double depth_mm) {
  // The disc must reach beyond the counting circle and the farthest zero that is followed.
  aim(kOutside * kFollowed * (roots_.empty() ? 1.0 : std::abs(roots_[0].xi)), depth_mm);
  if (depth_mm != depth_mm_) {
    // A root that is lost here is not lost for good: the count below misses it and search() looks
    // for it.
    std::erase_if(roots_, [&](Root& root) { return !follow(root, depth_mm_, depth_mm); });
    sort();
    depth_mm_ = depth_mm;
  }
  if (!verified(depth_mm) && !search(depth_mm)) {
    return by_arnoldi(depth_mm);
  }
  return upper(1.0 / roots_[0].xi);
}

std::optional<double> DepthTracker::border_mm(std::size_t steps) {
  double low = 0.0;
  double log_low = free_log_radius_;
  const auto log_radius = [this](double depth_mm) {
    return std::log(std::abs(dominant(depth_mm)));
  };
  for (std::size_t k = 1; k <= steps; ++k) {
    const double high = most_depth_mm_ * static_cast<double>(k) / static_cast<double>(steps);
    const double log_high = log_radius(high);
    // Bracketed by a stable and an unstable depth, the crossing itself is regula falsi.
    if (log_high >= 0.0) {
      return crossing(log_radius, {low, log_low}, {high, log_high});
    }
    low = high;
    log_low = log_high;
  }
  return std::nullopt;
}

}  // namespace steadyrest::chatter::offline
