// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <steadyrest/chatter/offline/depth_tracker.hpp>
#include <steadyrest/chatter/offline/multipliers.hpp>

namespace steadyrest::chatter::offline {
namespace {

using Complex = std::complex<double>;

constexpr double kMostXi = 3.0;     ///< smaller multipliers are left to Arnoldi's method
constexpr double kFollowed = 1.35;  ///< zeros farther out over the nearest are left
constexpr double kSpan = 0.2;       ///< of the depth, for which one disc is to serve
constexpr double kSame = 1e-7;      ///< two zeros are one, relative
constexpr double kLastStep = 1e-5;  ///< relative; the error left is far smaller
constexpr double kNudge = 1e-3;     ///< for derivatives, relative
constexpr double kLeastNudge = 1e-5;
constexpr double kLevelRatio = 3.0;
constexpr double kReal = 1e-7;  ///< |Im ξ| of a real zero, relative
constexpr int kMostSteps = 9;
constexpr std::size_t kMostRoots = 5;
constexpr std::size_t kSeeds = 6;
constexpr std::size_t kStarts = 9;
constexpr double kOutside = 1.12;  ///< radius of the counting circle over the zero within
constexpr double kBetween = 1.03;  ///< a zero nearer to the circle than this is taken inside
constexpr std::size_t kArc = 16;   ///< points on the half circle, a multiple of the lanes
constexpr double kMostTurn = 1.6;  ///< rad between neighbours
constexpr int kMostHalvings = 7;
constexpr int kMostCrossing = 60;
constexpr double kCrossed = 1e-10;   ///< bracket of the border, relative
constexpr double kOnBorder = 1e-12;  ///< ln|μ|

/// One of a conjugate pair; a real zero exactly real.
Complex upper(Complex xi) {
  return std::abs(xi.imag()) < kReal * std::abs(xi) ? Complex(xi.real())
         : xi.imag() < 0.0                          ? std::conj(xi)
                                                    : xi;
}

}  // namespace

DepthTracker::DepthTracker(Process process, double speed_rev_s, double most_depth_mm)
    : process_(std::move(process)), speed_rev_s_(speed_rev_s), most_depth_mm_(most_depth_mm) {
  for (const Complex& mu : pass(0.0).free()) {
    if (std::abs(mu) * kMostXi > 1.0) {
      roots_.push_back({upper(1.0 / mu), 0.0});
    }
  }
  sort();
}

void DepthTracker::sort() {
  std::ranges::sort(roots_, {}, [](const Root& r) { return std::abs(r.xi); });
  const auto same = [](const Root& a, const Root& b) {
    return std::abs(a.xi - b.xi) < kSame * std::abs(a.xi);
  };
  roots_.erase(std::unique(roots_.begin(), roots_.end(), same), roots_.end());
  const double most =
      roots_.empty() ? kMostXi : std::min(kMostXi, kFollowed * std::abs(roots_[0].xi));
  std::erase_if(roots_, [most](const Root& r) { return std::abs(r.xi) > most; });
  if (roots_.size() > kMostRoots) {
    roots_.resize(kMostRoots);
  }
}

const PassMatrix& DepthTracker::pass(double z_mm) {
  double most = (1.0 + 2.0 * kMostXi) * most_depth_mm_;
  std::size_t level = 0;
  while (level + 1 < kLevels && z_mm <= most / kLevelRatio) {
    most /= kLevelRatio;
    ++level;
  }
  if (!pass_[level]) {
    pass_[level] = std::make_unique<PassMatrix>(process_, speed_rev_s_, most);
  }
  return *pass_[level];
}

void DepthTracker::aim(double size, double depth_mm) {
  if (disc_ && disc_->holds(depth_mm, size * depth_mm)) {
    return;
  }
  for (double span = kSpan; span > 0.02; span *= 0.25) {
    const double center = (1.0 + 0.5 * span) * depth_mm;
    const double radius = 0.5 * span * depth_mm + size * (1.0 + span) * depth_mm;
    disc_ = PassDisc::make(pass(center + radius), center, radius, terms_);
    if (disc_) {
      terms_ = disc_->terms();
      return;
    }
  }
}

void DepthTracker::g(std::span<const Complex> xi, double depth_mm, std::span<Complex> out) {
  double square = 0.0;
  for (const Complex& x : xi) {
    square = std::max(square, std::norm(x));
  }
  const double size = std::sqrt(square);
  if (disc_ && disc_->holds(depth_mm, size * depth_mm)) {
    disc_->g(xi, depth_mm, out);
    return;
  }
  const PassMatrix& matrix = pass((1.0 + size) * depth_mm);
  for (std::size_t k = 0; k < xi.size(); k += PassMatrix::kLanes) {
    PassMatrix::Lanes lanes;
    std::copy_n(&xi[k], lanes.size(), lanes.begin());
    std::ranges::copy(matrix.g_lanes(lanes, depth_mm), &out[k]);
  }
}

/// Halley's steps, the derivatives from neighbours on either side; empty: they lead nowhere.
std::optional<Complex> DepthTracker::refine(Complex start, double depth_mm) {
  Complex x = start;
  double h = kNudge * std::abs(start);
  for (int i = 0; i < kMostSteps; ++i) {
    PassMatrix::Lanes at;
    g(PassMatrix::Lanes{x, x + h, x - h, x}, depth_mm, at);
    const Complex slope = (at[1] - at[2]) / (2.0 * h);
    const Complex bend = (at[1] - 2.0 * at[0] + at[2]) / (h * h);
    const Complex below = 2.0 * slope * slope - at[0] * bend;
    if (std::abs(below) == 0.0) {
      return at[0] == 0.0 ? std::optional<Complex>(x) : std::nullopt;
    }
    const Complex step = 2.0 * at[0] * slope / below;
    x -= step;
    if (!(std::abs(x) < 2.0 * kMostXi)) {
      return std::nullopt;
    }
    // What is left is about the cube of the step, and its product with the error of the slope.
    if (std::abs(step) < kLastStep * std::abs(x)) {
      return x;
    }
    h = std::clamp(0.3 * std::abs(step), kLeastNudge * std::abs(x), kNudge * std::abs(x));
  }
  return std::nullopt;
}

/// False: it could not be followed.
bool DepthTracker::follow(Root& root, double from_mm, double to_mm) {
  double at = from_mm;
  double step = to_mm - from_mm;
  for (int tries = 0; tries < 40; ++tries) {
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
      if (root.xi.imag() == 0.0) {
        root.slope = root.slope.real();
      }
      return true;
    }
    step = std::min(2.0 * step, to_mm - at);
  }
  return false;
}

/// Zeros of g with |ξ| < radius by the turns of its argument; empty: the circle passes too near to
/// one. Conjugate symmetry: half of the circle is enough.
std::optional<int> DepthTracker::zeros_within(double radius, double depth_mm) {
  struct Point {
    double angle;
    Complex g;
  };
  const auto at = [&](double angle) {
    const Complex xi = std::polar(radius, angle);
    PassMatrix::Lanes value;
    g(PassMatrix::Lanes{xi, xi, xi, xi}, depth_mm, value);
    return Point{angle, value[0]};
  };
  std::array<Point, kArc> arc{};
  std::array<Complex, kArc> xi;
  std::array<Complex, kArc> value;
  for (std::size_t k = 0; k < kArc; ++k) {
    arc[k].angle = std::numbers::pi * static_cast<double>(k) / static_cast<double>(kArc - 1);
    xi[k] = std::polar(radius, arc[k].angle);
  }
  g(xi, depth_mm, value);
  for (std::size_t k = 0; k < kArc; ++k) {
    arc[k].g = value[k];
  }
  double turn = 0.0;
  Point last = arc[0];
  for (std::size_t k = 1; k < kArc; ++k) {
    std::array<Point, kMostHalvings + 1> ahead{};
    std::size_t depth = 0;
    ahead[0] = arc[k];
    while (true) {
      const Point& next = ahead[depth];
      const double change = std::arg(next.g / last.g);
      if (std::abs(change) < kMostTurn) {
        turn += change;
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
      ahead[depth + 1] = at(0.5 * (last.angle + next.angle));
      ++depth;
    }
  }
  return static_cast<int>(std::lround(turn / std::numbers::pi));
}

/// All zeros within a circle that leaves the dominant one well inside are among those followed.
bool DepthTracker::verified(double depth_mm) {
  if (roots_.empty()) {
    return false;
  }
  const double dominant = std::abs(roots_[0].xi);
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

/// Looks for zeros that have come near from outside.
void DepthTracker::search(double depth_mm) {
  const double radius = roots_.empty() ? 1.0 : std::abs(roots_[0].xi);
  std::vector<Root> found;
  for (std::size_t k = 0; k < kStarts; ++k) {
    const double angle =
        std::numbers::pi * static_cast<double>(k) / static_cast<double>(kStarts - 1);
    if (const auto xi = refine(std::polar(radius, angle), depth_mm); xi) {
      found.push_back({upper(*xi), 0.0});
    }
  }
  for (const Root& root : found) {
    const bool known = std::ranges::any_of(roots_, [&](const Root& other) {
      return std::abs(other.xi - root.xi) < kSame * std::abs(root.xi);
    });
    if (!known) {
      roots_.push_back(root);
    }
  }
  sort();
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
    now.push_back({exact && std::abs(*exact - xi) < 1e-3 * std::abs(xi) ? upper(*exact) : xi, 0.0});
  }
  roots_ = std::move(now);
  sort();
  depth_mm_ = depth_mm;
  const Complex mu = found.value[0];
  return roots_.empty() ? Complex(mu.real(), std::abs(mu.imag())) : std::conj(1.0 / roots_[0].xi);
}

void DepthTracker::seed(double depth_mm) {
  if (!cycle_) {
    DelayCycle::Config config;
    config.speed_rev_s = speed_rev_s_;
    config.most_depth_mm = most_depth_mm_;
    auto made = DelayCycle::make(process_, config);
    cycle_ = std::make_unique<DelayCycle>(std::move(made.value()));
  }
  cycle_->set_depth(depth_mm);
}

Complex DepthTracker::dominant(double depth_mm) {
  aim(kOutside * kFollowed * (roots_.empty() ? 1.0 : std::abs(roots_[0].xi)), depth_mm);
  if (depth_mm != depth_mm_) {
    std::erase_if(roots_, [&](Root& root) { return !follow(root, depth_mm_, depth_mm); });
    sort();
    depth_mm_ = depth_mm;
  }
  if (!verified(depth_mm)) {
    search(depth_mm);
    if (!verified(depth_mm)) {
      return by_arnoldi(depth_mm);
    }
  }
  return upper(1.0 / roots_[0].xi);
}

/// Regula falsi that halves the ordinate of an end that stays (Illinois): ln|μ| is smooth but for
/// exchanges of the lead.
double DepthTracker::cross(double stable_mm, double unstable_mm, double log_unstable) {
  double a = stable_mm;
  double b = unstable_mm;
  double fa = stable_mm > 0.0 ? std::log(std::abs(dominant(stable_mm)))
                              : std::log(std::abs(pass(0.0).free()[0]));
  for (const Complex& mu : pass(0.0).free()) {
    fa = stable_mm > 0.0 ? fa : std::max(fa, std::log(std::abs(mu)));
  }
  double fb = log_unstable;
  int stayed = 0;  // > 0: the upper end
  for (int i = 0; i < kMostCrossing && b - a > kCrossed * b; ++i) {
    double middle = (a * fb - b * fa) / (fb - fa);
    if (!(middle > a && middle < b) || i % 12 == 11) {
      middle = 0.5 * (a + b);
    }
    const double f = std::log(std::abs(dominant(middle)));
    if (std::abs(f) < kOnBorder) {
      return middle;
    }
    if (f < 0.0) {
      fb *= stayed > 0 ? 0.5 : 1.0;
      a = middle;
      fa = f;
      stayed = 1;
    } else {
      fa *= stayed < 0 ? 0.5 : 1.0;
      b = middle;
      fb = f;
      stayed = -1;
    }
  }
  return 0.5 * (a + b);
}

std::optional<double> DepthTracker::border_mm(std::size_t steps) {
  double low = 0.0;
  for (std::size_t k = 1; k <= steps; ++k) {
    const double high = most_depth_mm_ * static_cast<double>(k) / static_cast<double>(steps);
    const double log_high = std::log(std::abs(dominant(high)));
    if (log_high < 0.0) {
      low = high;
      continue;
    }
    return cross(low, high, log_high);
  }
  return std::nullopt;
}

}  // namespace steadyrest::chatter::offline
