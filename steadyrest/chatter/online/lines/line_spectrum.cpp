// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <steadyrest/chatter/online/lines/line_spectrum.hpp>
#include <steadyrest/chatter/online/orders/detector_refusal.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// Copy, butterflies, power, noise floor and sum of the lines are steps of a state machine: each
// call does a portion, so that a transform of a thousand points never falls into one cycle.
namespace steadyrest::chatter::online {
namespace {

using kernel::units::kTurn;

// A line is this many times the noise, which a bin of white noise exceeds with e⁻¹⁰ = 5·10⁻⁵.
constexpr double kPart = 10.0;
constexpr double kClip = 3.0;  // bins above are not noise; of white noise e⁻³ = 5 % of them
// White noise's bins are exponential. Clipping at c = 3 times the mean leaves the mean
// 1 − c·e⁻ᶜ/(1 − e⁻ᶜ): 0.843, 0.781, 0.751, 0.735 after kNoisePasses, of which this is the inverse.
constexpr double kClipBias = 1.36;
constexpr double kHeard = 0.45;        // of the rate, as far as the OrderFilter knows the orders
constexpr double kHannEnergy = 0.375;  // mean of the squared window, sin⁴
constexpr double kBesideBins = 1.5;    // an order's line has 3 % of its peak there

/// Distance to the nearest multiple; 0 without a spacing.
double from_multiple(double hz, double spacing_hz) {
  return spacing_hz > 0.0 ? std::abs(hz - spacing_hz * std::round(hz / spacing_hz)) : 0.0;
}

}  // namespace

kernel::outcome::Result<LineSpectrum> LineSpectrum::make(const Config& config) {
  if (!(config.sample_rate_hz >= 1e3 && config.sample_rate_hz <= 50e3)) {
    return refuse_detector("sample rate is not within 1000…50000 Hz");
  }
  if (!(config.window_s >= 0.02 && config.window_s <= 1.0)) {
    return refuse_detector("window is not within 0.02…1 s");
  }
  if (!(config.lowest_hz >= 0.0 && config.lowest_hz <= 0.25 * config.sample_rate_hz)) {
    return refuse_detector("lowest frequency is not within 0…¼ of the sample rate");
  }
  // A power of 2 for the butterflies; the window is within a factor √2 of the requested one.
  const double wanted = std::log2(config.window_s * config.sample_rate_hz);
  const auto bits = static_cast<unsigned>(std::clamp(std::lround(wanted), 6L, 15L));
  return LineSpectrum(config, std::size_t{1} << bits);
}

LineSpectrum::LineSpectrum(const Config& config, std::size_t n)
    : config_(config),
      n_(n),
      bin_hz_(config.sample_rate_hz / static_cast<double>(n)),
      first_bin_(std::max<std::size_t>(
          2, static_cast<std::size_t>(std::ceil(config.lowest_hz / bin_hz_)))),
      end_bin_(static_cast<std::size_t>(kHeard * static_cast<double>(n))),
      ring_(2 * n),
      window_(n),
      reversed_(n),
      twiddle_(n / 2),
      bins_(n),
      before_(n),
      power_(n / 2) {
  const auto bits = static_cast<unsigned>(std::countr_zero(n));
  for (std::size_t i = 0; i < n; ++i) {
    const double phase = kTurn * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
    // Hann: its side lobes fall fast, so a strong tooth order does not mask a weak line.
    window_[i] = 0.5 * (1.0 - std::cos(phase));
    std::uint32_t r = 0;
    for (unsigned b = 0; b < bits; ++b) {
      r |= ((static_cast<std::uint32_t>(i) >> b) & 1U) << (bits - 1U - b);
    }
    reversed_[i] = r;
  }
  // Twiddles once, in full precision: a running product would lose digits over a thousand steps.
  for (std::size_t i = 0; i < n / 2; ++i) {
    twiddle_[i] = std::polar(1.0, -kTurn * static_cast<double>(i) / static_cast<double>(n));
  }
}

const LineSpectrum::Output& LineSpectrum::update(double value, const Orders& orders) noexcept {
  out_.fresh = false;
  ring_[head_] = value;
  head_ = head_ + 1 == ring_.size() ? 0 : head_ + 1;
  seen_ = std::min(seen_ + 1, n_);
  ++since_;
  if (step_ == Step::idle && seen_ == n_ && since_ >= n_ / 8) {
    passed_ = known_ ? since_ : 0;
    since_ = 0;
    step_ = Step::copy;
    std::swap(bins_, before_);
    at_ = 0;
    start_ = head_ >= n_ ? head_ - n_ : head_ + n_;  // the ring holds 2n
  }
  work(orders);
  return out_;
}

void LineSpectrum::work(const Orders& orders) noexcept {
  switch (step_) {
    case Step::idle:
      break;
    case Step::copy:
      copy();
      break;
    case Step::transform:
      transform();
      break;
    case Step::power:
      power(orders);
      break;
    case Step::noise:
      noise();
      break;
    case Step::lines:
      lines();
      break;
  }
}

void LineSpectrum::copy() noexcept {
  const std::size_t end = std::min(n_, at_ + kCopy);
  for (; at_ < end; ++at_) {
    const std::size_t i = start_ + at_;
    bins_[reversed_[at_]] = window_[at_] * ring_[i < ring_.size() ? i : i - ring_.size()];
  }
  if (at_ == n_) {
    step_ = Step::transform;
    at_ = 0;
    half_ = 1;
  }
}

/// Butterflies `at_` of the stage that joins halves of length `half_`.
void LineSpectrum::transform() noexcept {
  for (std::size_t done = 0; done < kQuota; ++done) {
    const std::size_t within = at_ & (half_ - 1);
    const std::size_t low = ((at_ - within) << 1U) + within;
    const std::complex<double> w = twiddle_[within * (n_ / (2 * half_))];
    const std::complex<double> a = bins_[low];
    const std::complex<double> b = bins_[low + half_];
    // Written out: std::complex's product tests for NaN.
    const std::complex<double> t(w.real() * b.real() - w.imag() * b.imag(),
                                 w.real() * b.imag() + w.imag() * b.real());
    bins_[low] = a + t;
    bins_[low + half_] = a - t;
    if (++at_ == n_ / 2) {
      at_ = 0;
      half_ *= 2;
      if (half_ == n_) {
        step_ = Step::power;
        at_ = first_bin_;
        falls_ = true;
        rises_ = ignored_ = false;
        peak_below_ = first_bin_;
        before_bin_ = 2.0 / (kHannEnergy * static_cast<double>(n_) * static_cast<double>(n_)) *
                      std::norm(bins_[first_bin_ - 1]);
        sum_ = 0.0;
        looked_at_ = 0;
        peak_ = first_bin_;
        beside_ = guarded_ = 0;
        return;
      }
    }
  }
}

void LineSpectrum::power(const Orders& orders) noexcept {
  const auto n = static_cast<double>(n_);
  // Energy of a real line over both of its bins, without the window's own energy.
  const double scale = 2.0 / (kHannEnergy * n * n);
  const std::size_t end = std::min(end_bin_, at_ + kCopy);
  for (; at_ < end; ++at_) {
    const double hz = static_cast<double>(at_) * bin_hz_;
    const double off_hz = orders.guard_hz > 0.0 ? from_multiple(hz, orders.spacing_hz) : hz;
    const bool skipped = orders.guard_hz > 0.0 && off_hz <= orders.guard_hz;
    const double p = scale * std::norm(bins_[at_]);
    // The skirt of an ignored line, or of one below the lowest frequency, is not a line: the bins
    // that rise to the middle of a gap and fall from there.
    const bool rises = p >= before_bin_;
    if (rises && !rises_) {
      peak_below_ = peak_;
      falls_ = false;
    } else if (!rises && rises_ && ignored_) {
      peak_ = peak_below_;
      falls_ = true;
    } else if (!rises && rises_ && power_[at_ - 1] > (beside_ > 0 ? power_[beside_] : 0.0) &&
               from_multiple(hz - bin_hz_, orders.spindle_hz) > kBesideBins * bin_hz_) {
      beside_ = at_ - 1;
    }
    rises_ = rises;
    ignored_ = skipped && off_hz < bin_hz_;
    before_bin_ = p;
    // Kept with its sign reversed: the interpolation of a peak beside a gap still needs the
    // neighbour.
    power_[at_] = skipped || falls_ ? -p : p;
    if (skipped && (guarded_ == 0 || p > std::abs(power_[guarded_]))) {
      guarded_ = at_;
    }
    if (!skipped && !falls_) {
      sum_ += p;
      ++looked_at_;
      peak_ = p > power_[peak_] ? at_ : peak_;
    }
  }
  if (at_ == end_bin_) {
    step_ = Step::noise;
    level_ = looked_at_ > 0 ? sum_ / static_cast<double>(looked_at_) : 0.0;
    pass_ = 0;
    at_ = first_bin_;
    sum_ = 0.0;
    count_ = 0;
  }
}

void LineSpectrum::noise() noexcept {
  const std::size_t end = std::min(end_bin_, at_ + kCopy);
  for (; at_ < end; ++at_) {
    const double p = power_[at_];
    // Noise power is exponential over the bins. Clipped at three times the level, its mean of 1
    // becomes 0.84, 0.78, 0.75 and after the fourth pass 0.735 = 1/kClipBias.
    if (p >= 0.0 && p <= kClip * level_) {
      sum_ += p;
      ++count_;
    }
  }
  if (at_ < end_bin_) {
    return;
  }
  level_ = count_ > 0 ? sum_ / static_cast<double>(count_) : level_;
  at_ = first_bin_;
  sum_ = 0.0;
  count_ = 0;
  if (++pass_ == kNoisePasses) {
    step_ = Step::lines;
    // Clipping also removes the noise's own peaks: its mean is too small by a known factor. Never
    // 0, since it is a divisor.
    level_ = std::max(kClipBias * level_, std::numeric_limits<double>::min());
  }
}

void LineSpectrum::lines() noexcept {
  const std::size_t end = std::min(end_bin_, at_ + kCopy);
  for (; at_ < end; ++at_) {
    sum_ += power_[at_] > kPart * level_ ? power_[at_] - level_ : 0.0;
  }
  if (at_ == end_bin_) {
    finish();
  }
}

LineSpectrum::Line LineSpectrum::line_at(std::size_t peak) const noexcept {
  // Under a Hann window a line at δ bins beside a bin has amplitudes in the ratio r = (1 + δ)/(2 −
  // δ); solved, δ = (2r − 1)/(r + 1) (Grandke 1983).
  const double here = std::abs(power_[peak]);
  const double left = std::abs(power_[std::max(peak, first_bin_ + 1) - 1]);
  const double right = std::abs(power_[std::min(peak + 1, end_bin_ - 1)]);
  const double ratio = here > 0.0 ? std::min(1.0, std::sqrt(std::max(left, right) / here)) : 0.5;
  // Of a line between two bins under a Hann window: exact for a single line.
  const double offset = (2.0 * ratio - 1.0) / (ratio + 1.0);
  const double sign = right >= left ? 1.0 : -1.0;
  return {.frequency_hz = (static_cast<double>(peak) + sign * offset) * bin_hz_,
          .peak_ratio = here / level_,
          .advance_turns = std::arg(bins_[peak] * std::conj(before_[peak])) / kTurn,
          .energy = left + here + right};
}

void LineSpectrum::finish() noexcept {
  step_ = Step::idle;
  out_.strongest = line_at(peak_);
  out_.strongest.peak_ratio = std::max(power_[peak_], 0.0) / level_;
  out_.beside = beside_ > 0 ? line_at(beside_) : Line{};
  out_.guarded = guarded_ > 0 ? line_at(guarded_) : Line{};
  out_.line_energy = sum_;
  out_.noise_energy = level_ * static_cast<double>(looked_at_) * (0.5 / kHeard);
  out_.advance_s = static_cast<double>(passed_) / config_.sample_rate_hz;
  known_ = true;
  out_.fresh = true;
}

void LineSpectrum::reset() noexcept {
  std::ranges::fill(ring_, 0.0);
  head_ = seen_ = since_ = passed_ = 0;
  known_ = false;
  step_ = Step::idle;
  out_ = {};
}

}  // namespace steadyrest::chatter::online
