// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/motion/online/line/ripple.hpp>

namespace steadyrest::motion::online {
namespace {

using kernel::units::kTurn;

// Which test fails when one is changed: README, "What the constants do".
constexpr double kLongest = 0.08;       ///< s; a window that took longer is not smooth motion
constexpr double kMostResidual = 0.15;  ///< counts
constexpr double kForgetPower = 0.9995;
constexpr double kForgetWave = 0.999;
constexpr double kStart = 0.05;  ///< counts, σ of an unknown coefficient
constexpr double kPower = 14.0;  ///< of a peak, over that of noise
constexpr double kShare = 0.1;   ///< least share of a wave in the residuals' power
constexpr std::int64_t kLeastLines =
    150;  ///< travelled before waves are told from random errors of the lines
constexpr double kLeastAmplitude = 0.004;  ///< counts
constexpr double kApart = 0.008;           ///< 1/count, least distance of two waves
constexpr double kSameWave = 0.004;        ///< 1/count, how far a wave is followed
constexpr double kFirstChoice = 32.0;      ///< residuals before the first choice
constexpr std::uint32_t kEvery = 16;       ///< residuals from choice to choice
constexpr double kFollow = 0.005;          ///< share of a residual in the mean squares
constexpr std::uint32_t kMostFresh = 2;
constexpr double kMostSlope = 0.3;

/// First column of the inverse of a symmetric positive 4×4 matrix of moments m[i + k]; false where
/// it is singular.
bool first_column(const std::array<double, 7>& m, std::array<double, 4>& out) noexcept {
  std::array<std::array<double, 5>, 4> a{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      a[i][k] = m[i + k];
    }
  }
  a[0][4] = 1.0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(a[i][i] > 1e-12)) {
      return false;
    }
    for (std::size_t r = i + 1; r < 4; ++r) {
      const double f = a[r][i] / a[i][i];
      for (std::size_t k = i; k < 5; ++k) {
        a[r][k] -= f * a[i][k];
      }
    }
  }
  for (std::size_t i = 4; i-- > 0;) {
    double sum = a[i][4];
    for (std::size_t k = i + 1; k < 4; ++k) {
      sum -= a[i][k] * out[k];
    }
    out[i] = sum / a[i][i];
  }
  return true;
}

}  // namespace

Ripple::Ripple() noexcept {
  for (std::size_t i = 0; i < cosine_.size(); ++i) {
    cosine_[i] = std::cos(kTurn * static_cast<double>(i) / kCircle);
  }
}

/// cos 2πu between the places of the table, error below 5e-6.
double Ripple::cosine(double turns) const noexcept {
  const double at = (turns - std::floor(turns)) * static_cast<double>(kCircle);
  const auto i = std::min(static_cast<std::size_t>(at), kCircle - 1);
  return cosine_[i] + (at - static_cast<double>(i)) * (cosine_[i + 1] - cosine_[i]);
}

void Ripple::edge(double t_s, std::int64_t line, std::int8_t direction, bool lost) noexcept {
  if (!started_) {
    origin_ = line;
    started_ = true;
  }
  if (lost || direction != direction_ || line != last_line_ + direction) {
    count_ = 0;
  }
  direction_ = direction;
  last_line_ = line;
  t_s_[next_] = t_s;
  next_ = (next_ + 1) % kWindow;
  count_ = std::min(count_ + 1, kWindow);
  ++fresh_;
}

void Ripple::learn() noexcept {
  const std::uint32_t fresh = std::exchange(fresh_, 0U);
  // More than two lines in a tick: only every third line or fewer would teach, and its waves would
  // be ambiguous.
  if (fresh == 0 || fresh > kMostFresh || count_ < kWindow || !weigh()) {
    return;
  }
  teach();
  search();
  if (++since_choice_ >= kEvery && weight_sum_ >= kFirstChoice &&
      highest_ - lowest_ >= kLeastLines) {
    choose();
    since_choice_ = 0;
  }
}

/// The middle passage minus the cubic through all, as weights of the passages.
bool Ripple::weigh() noexcept {
  constexpr std::size_t kMiddle = kWindow / 2;
  const std::size_t newest = (next_ + kWindow - 1) % kWindow;
  const double span = t_s_[newest] - t_s_[next_];
  if (!(span > 0.0) || span > kLongest) {
    return false;
  }
  const double centre = t_s_[(next_ + kMiddle) % kWindow];
  std::array<double, kWindow> u{};
  std::array<double, 7> moments{};
  for (std::size_t i = 0; i < kWindow; ++i) {
    // Scaled to about ±1: moments up to u⁶ then stay of one order.
    u[i] = 2.0 * (t_s_[(next_ + i) % kWindow] - centre) / span;
    double power = 1.0;
    for (double& m : moments) {
      m += power;
      power *= u[i];
    }
  }
  std::array<double, 4> g{};
  if (!first_column(moments, g)) {
    return false;
  }
  residual_ = 0.0;
  for (std::size_t i = 0; i < kWindow; ++i) {
    // The fit's value at u = 0 is its first coefficient, a weighted sum of the positions; the
    // weights need no positions, only times.
    weight_[i] = (i == kMiddle ? 1.0 : 0.0) - (g[0] + u[i] * (g[1] + u[i] * (g[2] + u[i] * g[3])));
    // Positions are consecutive counts, so the index represents them.
    residual_ += weight_[i] * (static_cast<double>(i) - static_cast<double>(kMiddle));
  }
  residual_ *= direction_;
  sense_ = direction_;
  middle_ = last_line_ - origin_ - static_cast<std::int64_t>(kMiddle) * direction_;
  return std::abs(residual_) < kMostResidual;
}

// Recursive least squares with forgetting. The wave goes through the same weights d as the
// positions, so that whatever the cubic removes from it is also removed from the prediction; cos
// and sin along the window need one rotation per line.
void Ripple::teach() noexcept {
  std::array<double, kStates> h{};
  const auto first = static_cast<double>(middle_ - static_cast<std::int64_t>(kWindow / 2) * sense_);
  double expected = 0.0;
  for (std::size_t j = 0; j < kWaves; ++j) {
    if (!wave_[j].used) {
      continue;
    }
    const double f = wave_[j].frequency;
    const double cr = cosine(f);
    const double sr = sense_ * cosine(f - 0.25);
    double c = cosine(f * first);
    double s = cosine(f * first - 0.25);
    for (const double d : weight_) {
      // The same weights on the wave: the residual of the wave alone.
      h[2 * j] += d * c;
      h[2 * j + 1] += d * s;
      const double next = c * cr - s * sr;
      s = s * cr + c * sr;
      c = next;
    }
    expected += h[2 * j] * c_[2 * j] + h[2 * j + 1] * c_[2 * j + 1];
  }
  const double nu = residual_ - expected;
  noise_ += kFollow * (nu * nu - noise_);
  power_ += kFollow * (residual_ * residual_ - power_);
  if (!active_) {
    return;
  }
  std::array<double, kStates> g{};
  double total = 4.0 * std::max(noise_, 1e-5);
  for (std::size_t i = 0; i < kStates; ++i) {
    for (std::size_t k = 0; k < kStates; ++k) {
      g[i] += p_[i][k] * h[k];
    }
    total += h[i] * g[i];
  }
  std::array<double, kStates> scale{};
  for (std::size_t i = 0; i < kStates; ++i) {
    c_[i] += g[i] * nu / total;
    const double left = (p_[i][i] - g[i] * g[i] / total) / kForgetWave;
    // Forgetting must not inflate a variance beyond its initial value: rows and columns are scaled
    // alike, so that P stays positive.
    scale[i] = left > kStart * kStart ? kStart / std::sqrt(left) : 1.0;
  }
  for (std::size_t i = 0; i < kStates; ++i) {
    for (std::size_t k = 0; k < kStates; ++k) {
      p_[i][k] = (p_[i][k] - g[i] * g[k] / total) / kForgetWave * scale[i] * scale[k];
    }
  }
}

// Discrete Fourier sums over position, bins 1/1024 per count apart; only sums are kept, so the
// window may be as long as the axis travels.
void Ripple::search() noexcept {
  weight_sum_ = kForgetPower * weight_sum_ + 1.0;
  square_sum_ = kForgetPower * square_sum_ + residual_ * residual_;
  lowest_ = std::min(lowest_, middle_);
  highest_ = std::max(highest_, middle_);
  // Bins are 1/kCircle apart, so phases repeat every kCircle lines and whole numbers do.
  const auto place = static_cast<std::size_t>(middle_) % kCircle;
  std::size_t at = kFirstBin * place % kCircle;
  for (std::size_t k = 0; k < kBins; ++k) {
    cosine_sum_[k] = kForgetPower * cosine_sum_[k] + residual_ * cosine_[at];
    sine_sum_[k] =
        kForgetPower * sine_sum_[k] + residual_ * cosine_[(at + 3 * kCircle / 4) % kCircle];
    at = (at + place) % kCircle;
  }
}

/// The strongest peaks of the power, strongest first; power 0 where there are no more.
std::array<Ripple::Peak, Ripple::kWaves> Ripple::peaks() const noexcept {
  std::array<Peak, kWaves> out{};
  std::array<double, kBins> power{};
  for (std::size_t k = 0; k < kBins; ++k) {
    power[k] = cosine_sum_[k] * cosine_sum_[k] + sine_sum_[k] * sine_sum_[k];
  }
  const double least =
      std::max(std::max(kPower, 0.5 * kShare * weight_sum_) * square_sum_,
               0.25 * kLeastAmplitude * kLeastAmplitude * weight_sum_ * weight_sum_);
  for (std::size_t j = 0; j < kWaves; ++j) {
    for (std::size_t k = 1; k + 1 < kBins; ++k) {
      if (power[k] < least || power[k] <= out[j].power || power[k] < power[k - 1] ||
          power[k] < power[k + 1]) {
        continue;
      }
      const double bend = power[k - 1] - 2.0 * power[k] + power[k + 1];
      // Vertex of the parabola through three bins.
      const double off = bend < 0.0 ? 0.5 * (power[k - 1] - power[k + 1]) / bend : 0.0;
      const double f = (static_cast<double>(k + kFirstBin) + off) / kCircle;
      bool far = true;
      for (std::size_t i = 0; i < j; ++i) {
        far = far && std::abs(out[i].frequency - f) >= kApart;
      }
      if (far) {
        out[j] = {power[k], f};
      }
    }
    if (out[j].power == 0.0) {
      break;
    }
  }
  return out;
}

/// Waves in use follow their peaks or are dropped; new peaks take the free slots.
void Ripple::choose() noexcept {
  std::array<Peak, kWaves> found = peaks();
  for (std::size_t j = 0; j < kWaves; ++j) {
    if (!wave_[j].used) {
      continue;
    }
    Peak* nearest = nullptr;
    for (Peak& peak : found) {
      const double off = std::abs(peak.frequency - wave_[j].frequency);
      if (peak.power > 0.0 && off < kSameWave &&
          (nearest == nullptr || off < std::abs(nearest->frequency - wave_[j].frequency))) {
        nearest = &peak;
      }
    }
    if (nearest == nullptr) {
      wave_[j].used = false;
      c_[2 * j] = c_[2 * j + 1] = 0.0;
      continue;
    }
    // The wave's value here stays.
    // Far from line 0 a small change of frequency turns the phase by many turns: the coefficients
    // are rotated back by as much.
    const double turns = (nearest->frequency - wave_[j].frequency) * static_cast<double>(middle_);
    const double cr = cosine(turns);
    const double sr = cosine(turns - 0.25);
    const double a = c_[2 * j];
    const double b = c_[2 * j + 1];
    c_[2 * j] = a * cr - b * sr;
    c_[2 * j + 1] = a * sr + b * cr;
    wave_[j].frequency = nearest->frequency;
    nearest->power = 0.0;
  }
  for (std::size_t j = 0; j < kWaves; ++j) {
    const auto fresh =
        std::find_if(found.begin(), found.end(), [](const Peak& p) { return p.power > 0.0; });
    if (!wave_[j].used && fresh != found.end()) {
      take_up(j, *fresh);
      fresh->power = 0.0;
    }
  }
  double slope = 0.0;
  active_ = false;
  for (std::size_t j = 0; j < kWaves; ++j) {
    active_ = active_ || wave_[j].used;
    slope += kTurn * wave_[j].frequency * amplitude(j);
  }
  // Far below 1, at which the waves would make the axis reverse between two lines.
  if (slope > kMostSlope) {
    for (double& c : c_) {
      c *= kMostSlope / slope;
    }
  }
}

void Ripple::take_up(std::size_t j, const Peak& peak) noexcept {
  wave_[j] = {peak.frequency, true};
  for (const std::size_t i : {2 * j, 2 * j + 1}) {
    c_[i] = 0.0;
    for (std::size_t k = 0; k < kStates; ++k) {
      p_[i][k] = p_[k][i] = 0.0;
    }
    p_[i][i] = kStart * kStart;
  }
}

double Ripple::amplitude(std::size_t j) const noexcept {
  return wave_[j].used ? std::hypot(c_[2 * j], c_[2 * j + 1]) : 0.0;
}

Ripple::Value Ripple::at(double counts) const noexcept {
  Value out;
  if (!active()) {
    return out;
  }
  const double n = counts - static_cast<double>(origin_);
  for (std::size_t j = 0; j < kWaves; ++j) {
    if (!wave_[j].used) {
      continue;
    }
    const double f = wave_[j].frequency;
    const double w = kTurn * f;
    const double c = cosine(f * n);
    const double s = cosine(f * n - 0.25);
    const double value = c_[2 * j] * c + c_[2 * j + 1] * s;
    out.counts += value;
    out.slope += w * (c_[2 * j + 1] * c - c_[2 * j] * s);
  }
  return out;
}

double Ripple::at_line(std::int64_t line) const noexcept {
  double out = 0.0;
  if (active()) {
    const auto n = static_cast<double>(line - origin_);
    for (std::size_t j = 0; j < kWaves; ++j) {
      if (wave_[j].used) {
        const double turns = wave_[j].frequency * n;
        out += c_[2 * j] * cosine(turns) + c_[2 * j + 1] * cosine(turns - 0.25);
      }
    }
  }
  return out;
}

}  // namespace steadyrest::motion::online
