// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <steadyrest/chatter/online/free_share.hpp>
#include <steadyrest/chatter/online/orders/detector_refusal.hpp>
#include <steadyrest/kernel/units/constants.hpp>

// shift() moves the line to 0 Hz and thins signal and orders to 625 rows a second; rate() projects
// the tooth orders out and finds the mode's pole from the residual; mode() fits ring-down, orders
// and the mode's response to them by least squares, for each of three poles. Whatever no pole
// explains is free. The work is done in portions, one column or a few samples per call.
namespace steadyrest::chatter::online {
namespace {

using kernel::units::kTurn;

using Complex = std::complex<double>;

// README, "What the constants do". 64 blocks are 0.1 s, the window of the spectrum.
constexpr double kBlockRate = 625.0;  // 1/s
constexpr double kSame = 1e-3;        // of a column's energy: earlier columns give the rest
constexpr std::size_t kSpare = 4;     // rows in excess of columns
constexpr std::size_t kLeastRows = 20;
constexpr double kLeastBand = 100.0;     // Hz, either side of the line
constexpr double kFastestDecay = 400.0;  // 1/s

Complex times(Complex a, Complex b) noexcept {  // without the operator's NaN test
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

}  // namespace

kernel::outcome::Result<FreeShare> FreeShare::make(const Config& config) {
  const bool rate = config.sample_rate_hz >= 1e3 && config.sample_rate_hz <= 50e3;
  if (!rate || config.teeth < 1 || config.teeth > 64) {
    return refuse_detector("sample rate is not within 1000…50000 Hz or teeth are not within 1…64");
  }
  return FreeShare(config,
                   static_cast<std::size_t>(std::lround(config.sample_rate_hz / kBlockRate)));
}

FreeShare::FreeShare(const Config& config, std::size_t block)
    : config_(config),
      block_(block),
      taps_(4 * block),
      value_(2 * kBlocks * block),
      angle_(2 * kBlocks * block) {
  const auto n = static_cast<double>(taps_.size());
  for (std::size_t i = 0; i < taps_.size(); ++i) {
    // Hann, scaled to a sum of 1.
    taps_[i] = (1.0 - std::cos(kTurn * (static_cast<double>(i) + 0.5) / n)) / n;
    // White noise of energy 1 leaves Σ taps² in the shifted band; twice that for the conjugate band
    // of a real signal.
    out_.noise_share += 2.0 * taps_[i] * taps_[i];
  }
}

const FreeShare::Output& FreeShare::update(double value, double angle_rev) noexcept {
  out_.fresh = false;
  value_[head_] = value;
  // Only whole orders use it, so whole turns are dropped before they cost digits.
  angle_[head_] = angle_rev - std::floor(angle_rev);
  head_ = head_ + 1 == value_.size() ? 0 : head_ + 1;
  seen_ = std::min(seen_ + 1, kBlocks * block_);
  switch (step_) {
    case Step::idle:
      break;
    case Step::shift:
      shift();
      break;
    case Step::rate:
      rate();
      break;
    case Step::mode:
      mode();
      break;
  }
  return out_;
}

void FreeShare::ask(double frequency_hz, double speed_rev_s, std::size_t samples) noexcept {
  if (busy()) {
    return;
  }
  const std::size_t length = kBlocks * block_;
  const std::size_t used = std::min(samples, seen_);
  first_row_ = (length - std::min(used, length) + block_ - 1) / block_;
  frequency_hz_ = frequency_hz;
  choose_orders(speed_rev_s);
  out_.known = first_row_ + kLeastRows <= kRows;
  start_ = head_ >= length ? head_ - length : head_ + length;  // the rings hold twice as much
  at_ = std::min(first_row_, kRows) * block_;
  const double step = -kTurn * frequency_hz / config_.sample_rate_hz;
  turn_ = std::polar(1.0, step);
  turned_ = 1.0;
  z_.fill(0.0);
  for (std::size_t k = 0; k < orders_; ++k) {
    u_[k].fill(0.0);
  }
  step_ = Step::shift;
}

/// Where the spindle's orders are too close, or too many lie between two tooth orders, only the
/// tooth orders are used.
void FreeShare::choose_orders(double speed_rev_s) noexcept {
  constexpr double kHalf = 0.5 * static_cast<double>(kMostOrders) - 1.0;
  const auto teeth = static_cast<double>(config_.teeth);
  // All spindle orders only where enough of them fit into the columns to cover the least band.
  stride_ = teeth > kHalf || kHalf * speed_rev_s < kLeastBand ? config_.teeth : 1;
  const double spacing_hz = speed_rev_s * static_cast<double>(stride_);
  const double at = frequency_hz_ / spacing_hz;
  const double wanted = std::max(kBand / spacing_hz, stride_ == 1 ? teeth : 1.0);
  const double reach = std::min(wanted, kHalf);
  const double low = std::max(1.0, std::ceil(at - reach));
  const double high = std::floor(at + reach);
  first_order_ = stride_ * static_cast<std::size_t>(low);
  orders_ = high >= low ? static_cast<std::size_t>(high - low) + 1 : 0;
}

bool FreeShare::is_tooth(std::size_t at) const noexcept {
  return (first_order_ + at * stride_) % config_.teeth == 0;
}

void FreeShare::shift() noexcept {
  const std::size_t length = kBlocks * block_;
  const std::size_t end = std::min(length, at_ + kQuota);
  for (; at_ < end; ++at_) {
    const std::size_t i = start_ + at_;
    const std::size_t ring = i < value_.size() ? i : i - value_.size();
    const double angle = kTurn * angle_[ring];
    const Complex once = std::polar(1.0, angle * static_cast<double>(stride_));
    Complex order = times(turned_, std::polar(1.0, angle * static_cast<double>(first_order_)));
    const std::size_t block = at_ / block_;
    const std::size_t low = std::max(first_row_, block < 3 ? 0 : block - 3);
    const std::size_t high = std::min(block, kRows - 1);
    std::array<double, 4> tap{};
    for (std::size_t row = low; row <= high; ++row) {
      tap[row - low] = taps_[at_ - row * block_];
      // Each sample falls into up to four overlapping windows.
      z_[row] += tap[row - low] * value_[ring] * turned_;
    }
    for (std::size_t k = 0; k < orders_; ++k) {
      for (std::size_t row = low; row <= high; ++row) {
        u_[k][row] += tap[row - low] * order;
      }
      order = times(order, once);
    }
    turned_ = times(turned_, turn_);
  }
  if (at_ == length) {
    step_ = out_.known ? Step::rate : Step::mode;
    at_ = 0;
    columns_ = 0;
    if (!out_.known) {
      finish();
    }
  }
}

/// Subtracts the basis' share from a column.
void FreeShare::off(Column& column, Span span) const noexcept {
  // One after the other (modified Gram–Schmidt): the classical form loses orthogonality on columns
  // as nearly alike as neighbouring orders.
  for (std::size_t c = 0; c < columns_; ++c) {
    const Column& b = basis_[c];
    Complex share = 0.0;
    for (std::size_t i = span.first; i < span.last; ++i) {
      share += times(std::conj(b[i]), column[i]);
    }
    for (std::size_t i = span.first; i < span.last; ++i) {
      column[i] -= times(share, b[i]);
    }
  }
}

void FreeShare::add(const Column& column, Span span) noexcept {
  // As many columns as rows would fit anything.
  if (columns_ == kColumns || columns_ + kSpare >= span.size()) {
    return;
  }
  const auto energy = [&](const Column& c) {
    double sum = 0.0;
    for (std::size_t i = span.first; i < span.last; ++i) {
      sum += std::norm(c[i]);
    }
    return sum;
  };
  Column& left = basis_[columns_];
  left = column;
  const double whole = energy(left);
  off(left, span);
  const double rest = energy(left);
  // A column nearly given by the others would only add noise.
  if (whole > 1e-6 * static_cast<double>(span.size()) && rest > kSame * whole) {
    const double scale = 1.0 / std::sqrt(rest);
    for (std::size_t i = span.first; i < span.last; ++i) {
      left[i] *= scale;
    }
    ++columns_;
  }
}

/// Rows n that have z[n + 1] and z[n − kLag].
void FreeShare::rate() noexcept {
  const Span span{first_row_ + kLag, kRows - 1};
  while (at_ < orders_ && !is_tooth(at_)) {
    ++at_;
  }
  if (at_ == orders_) {
    solve_rate();
    return;
  }
  Column ahead{};
  for (std::size_t i = span.first; i < span.last; ++i) {
    ahead[i] = u_[at_][i + 1];
  }
  add(u_[at_], span);
  add(ahead, span);
  ++at_;
}

void FreeShare::solve_rate() noexcept {
  const Span span{first_row_ + kLag, kRows - 1};
  Column now = z_;
  Column next{};
  Column before{};
  for (std::size_t i = span.first; i < span.last; ++i) {
    next[i] = z_[i + 1];
    before[i] = z_[i - kLag];
  }
  off(now, span);
  off(next, span);
  off(before, span);
  // The instrument fails where little is left of z; then use plain least squares.
  const double rate = config_.sample_rate_hz / static_cast<double>(block_);
  for (std::size_t p = 0; p < 2; ++p) {
    const Column& instrument = p == 0 ? before : now;
    Complex num = 0.0;
    Complex den = 0.0;
    for (std::size_t i = span.first; i < span.last; ++i) {
      num += times(std::conj(instrument[i]), next[i]);
      den += times(std::conj(instrument[i]), now[i]);
    }
    // IV estimate a = ⟨w, z[n+1]⟩/⟨w, z[n]⟩: with w = z[n−4] the noise of z[n] is uncorrelated;
    // with w = z it is correlated and damps a.
    const Complex a = std::norm(den) > 0.0 ? num / den : Complex(1.0, 0.0);
    const double growth = rate * std::log(std::max(std::abs(a), 1e-6));
    out_.growth_1_s = p == 0 ? growth : out_.growth_1_s;
    const double decay = std::clamp(-growth, kLeastDecay, kFastestDecay);
    poles_[p] = std::polar(std::exp(-decay / rate), std::arg(a));
  }
  // The mode hardly changes from one query to the next: the last answer is tried too, and the pole
  // with the smallest residual counts.
  poles_[2] = std::polar(best_size_, kTurn * (best_hz_ - frequency_hz_) / rate);
  pole_ = 0;
  out_.off_teeth = out_.off_spindle = std::numeric_limits<double>::max();
  start_mode();
}

void FreeShare::start_mode() noexcept {
  columns_ = 0;
  at_ = 0;
  step_ = Step::mode;
  // A mode struck at the start rings down as powers of its pole.
  Column ring{};
  Complex power = 1.0;
  for (std::size_t i = first_row_; i < kRows; ++i) {
    ring[i] = power;
    power = times(power, poles_[pole_]);
  }
  add(ring, {first_row_, kRows});
  off_teeth_ = -1.0;
}

/// The tooth orders first, then the others.
void FreeShare::mode() noexcept {
  const Span span{first_row_, kRows};
  const auto left = [&] {
    Column rest = z_;
    off(rest, span);
    double sum = 0.0;
    for (std::size_t i = span.first; i < span.last; ++i) {
      sum += std::norm(rest[i]);
    }
    // Per degree of freedom, so that more columns do not win by number alone.
    return 2.0 * sum / static_cast<double>(span.size() - columns_);
  };
  while (at_ < 2 * orders_ && is_tooth(at_ % orders_) != (at_ < orders_)) {
    ++at_;
  }
  if (at_ >= orders_ && off_teeth_ < 0.0) {
    off_teeth_ = left();
    return;
  }
  if (at_ >= 2 * orders_) {
    if (off_teeth_ < out_.off_teeth) {
      out_.off_teeth = off_teeth_;
      best_now_ = pole_;
    }
    out_.off_spindle = std::min(out_.off_spindle, left());
    if (++pole_ < kPoles) {
      start_mode();
    } else {
      const double rate = config_.sample_rate_hz / static_cast<double>(block_);
      best_size_ = std::abs(poles_[best_now_]);
      best_hz_ = frequency_hz_ + std::arg(poles_[best_now_]) * rate / kTurn;
      finish();
    }
    return;
  }
  const Column& u = u_[at_ % orders_];
  Column answer{};
  for (std::size_t i = span.first + 1; i < span.last; ++i) {
    // The mode's response to an order that drives it: x[n] = a·x[n−1] + (u[n−1] + u[n])/2, a
    // trapezium.
    answer[i] = times(poles_[pole_], answer[i - 1]) + 0.5 * (u[i - 1] + u[i]);
  }
  add(answer, span);
  add(u, span);
  ++at_;
}

void FreeShare::finish() noexcept {
  double sum = 0.0;
  for (std::size_t i = std::min(first_row_, kRows); i < kRows; ++i) {
    sum += std::norm(z_[i]);
  }
  out_.energy = out_.known ? 2.0 * sum / static_cast<double>(kRows - first_row_) : 0.0;
  out_.fresh = true;
  step_ = Step::idle;
}

void FreeShare::reset() noexcept {
  head_ = seen_ = 0;
  step_ = Step::idle;
  const double noise_share = out_.noise_share;
  out_ = {};
  out_.noise_share = noise_share;
}

}  // namespace steadyrest::chatter::online
