// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/chatter/online/orders/spindle_track.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::chatter::online {
namespace {

using kernel::units::kTurn;

constexpr double kBlock_s = 0.02;        // of whole revolutions, about
constexpr double kLeastSamples = 100.0;  // of a block
constexpr double kUnsure = 0.002;        // above it blocks have only so many samples
constexpr double kLeastNoise = 0.05;     // of the residual's energy
constexpr double kSettledRev = 12.0;
constexpr double kRingsRev = 3.0;
constexpr double kMostMissing = 0.2;  // of a block
constexpr double kLeastSnr = 8.0;     // of an order's energy over its noise's
constexpr double kRestless = 0.015;   // rad: phases of orders wander with the engagement
constexpr double kWithinTurns = 0.4;  // that an order may have turned by
constexpr double kPriorSigmas = 3.0;
constexpr double kSigmas2 = 9.0;  // squared, that an order may stray from those below it
constexpr double kSigmasOfReach = 2.0;
constexpr double kForget = 0.15;          // of a block, of how an order strays from the others
constexpr double kUnknownStrange = 0.03;  // rad²
constexpr double kOutlier = 2.0;          // standard deviations
constexpr double kMostApart = 30.0;
constexpr double kWalk = 0.0003;    // relative, in a second
constexpr double kInAir = 0.005;    // relative: what a load may change
constexpr double kLost = 0.003;     // relative, in a second, where vibration hides the orders
constexpr double kMoreInAir = 2.0;  // of what the speed may be off anyway
constexpr double kMostGain = 0.5;
constexpr double kLag = 0.3;  // of a block, of what the blocks find again and again
constexpr double kRestlessBlocks = 8.0;
constexpr double kMostRestless = 1e4;
constexpr std::size_t kFewToAgree = 3;
constexpr std::size_t kMajority = 2;  // must agree for each that is left out
constexpr unsigned kFewStrays = 3;
constexpr double kLeastVariance = 1e-12;

std::complex<double> phasor(const OrderFilter::Order& order) {
  return {order.c, -order.s};
}

}  // namespace

SpindleTrack::SpindleTrack(double told_sd, std::size_t orders)
    : told_sd_(told_sd),
      at_begin_(orders),
      before_(orders),
      now_(orders),
      strange_(orders, kUnknownStrange),
      variance_(told_sd * told_sd) {
  turned_.reserve(orders);
}

double SpindleTrack::sd() const noexcept {
  return std::hypot(std::sqrt(variance_), behind_);
}

void SpindleTrack::begin_block(OrderFilter& filter, double angle_rev, double speed_rev_s,
                               double rate_hz) noexcept {
  filter.begin_block();
  const auto orders = filter.orders();
  for (std::size_t i = 0; i < orders.size(); ++i) {
    at_begin_[i] = phasor(orders[i]);
  }
  begin_rev_ = angle_rev;
  const double least_s = kLeastSamples / rate_hz;
  const double block_s = sd() > kUnsure ? least_s : std::max(kBlock_s, least_s);
  const double block_rev = std::max(1.0, std::round(block_s * speed_rev_s));
  comparable_ = comparable_ && block_rev == block_rev_;
  block_rev_ = block_rev;
  samples_ = missing_ = 0;
}

void SpindleTrack::update(OrderFilter& filter, double angle_rev, double speed_rev_s, double rate_hz,
                          const Residual& residual) noexcept {
  if (told_sd_ <= 0.0) {
    return;
  }
  // What the entry strikes rings, and turns the orders together.
  if (!started_ || residual.cut_rev < kRingsRev) {
    started_ = true;
    comparable_ = false;
    begin_block(filter, angle_rev, speed_rev_s, rate_hz);
    return;
  }
  ++samples_;
  missing_ += residual.gap ? 1 : 0;
  if (angle_rev - begin_rev_ < block_rev_) {
    return;
  }
  if (static_cast<double>(missing_) > kMostMissing * static_cast<double>(samples_)) {
    begin_block(filter, angle_rev, speed_rev_s, rate_hz);
    comparable_ = false;
    return;
  }
  const auto orders = filter.orders();
  const double each = 2.0 / static_cast<double>(samples_);
  const bool settled = residual.cut_rev > kSettledRev;
  double at_orders = 0.0;
  double free_share = 1.0;
  for (std::size_t i = 0; i < orders.size(); ++i) {
    const OrderFilter::Order& order = orders[i];
    const Complex left = each * Complex(order.block_c, -order.block_s);
    now_[i] = 0.5 * (at_begin_[i] + phasor(order)) + left;
    if (settled && order.used && order.tooth && !order.folded) {
      at_orders += 0.5 * std::norm(left);
      free_share -= each;
    }
  }
  const double noise_energy = std::max(kLeastNoise * residual.energy,
                                       (residual.energy - at_orders) / std::max(0.5, free_share));
  // Of white noise with that energy |Y|² has 4/n.
  const Fit found = comparable_ ? fit(orders, 2.0 * each * noise_energy) : Fit{};
  follow(found, static_cast<double>(samples_) / rate_hz, residual.loud);
  std::swap(now_, before_);
  comparable_ = true;
  begin_block(filter, angle_rev, speed_rev_s, rate_hz);
}

/// From the lowest order up: what those below say tells by how many turns more the next has turned,
/// and whether its phase is its own. Chatter has a line beside each tooth order, all at one
/// distance, and hides the higher ones.
void SpindleTrack::gather(std::span<const OrderFilter::Order> orders,
                          double noise_energy) noexcept {
  turned_.clear();
  left_out_ = 0;
  const double prior = kPriorSigmas * sd() * kTurn * block_rev_;
  double below = 1.0 / (prior * prior);
  double above = 0.0;
  for (std::size_t i = 1; i < orders.size(); ++i) {
    const double k = orders[i].order;
    if (!orders[i].used || orders[i].folded) {
      continue;
    }
    const double energy = std::min(std::norm(now_[i]), std::norm(before_[i]));
    if (!(energy > kLeastSnr * noise_energy)) {
      strange_[i] += kForget * (kUnknownStrange - strange_[i]);
      continue;
    }
    if (kSigmasOfReach * k / std::sqrt(below) > kWithinTurns * kTurn) {
      break;
    }
    const double expected = k * above / below;
    const double phase = std::arg(now_[i] * std::conj(before_[i]));
    const double turned = expected + std::remainder(phase - expected, kTurn);
    const double noise = noise_energy / energy;
    const double stray = turned - expected;
    if (stray * stray > kSigmas2 * (k * k / below + noise + kRestless * kRestless)) {
      strange_[i] += kForget * (stray * stray - strange_[i]);
      ++left_out_;
      continue;
    }
    const double v = noise + std::max(kRestless * kRestless, strange_[i]);
    turned_.push_back({.at = i, .order = k, .turned = turned, .sd = std::sqrt(v)});
    above += k * turned / v;
    below += k * k / v;
  }
}

/// What has Σ |aₖ − k·δ|/√vₖ least: the median of aₖ/k, weighted with k/√vₖ. Chatter beside some of
/// the orders does not move it.
double SpindleTrack::median() noexcept {
  std::ranges::sort(turned_, {}, [](const Turned& t) { return t.turned / t.order; });
  double all = 0.0;
  for (const Turned& t : turned_) {
    all += t.order / t.sd;
  }
  double sum = 0.0;
  for (const Turned& t : turned_) {
    sum += t.order / t.sd;
    if (2.0 * sum >= all) {
      return t.turned / t.order;
    }
  }
  return 0.0;
}

SpindleTrack::Fit SpindleTrack::fit(std::span<const OrderFilter::Order> orders,
                                    double noise_energy) noexcept {
  gather(orders, noise_energy);
  if (turned_.size() < std::max(kFewToAgree, kMajority * left_out_)) {
    for (const Turned& t : turned_) {
      strange_[t.at] += kForget * (t.turned * t.turned - strange_[t.at]);
    }
    return {};
  }
  const double middle = median();
  double above = 0.0;
  double below = 0.0;
  double apart = 0.0;
  for (const Turned& t : turned_) {
    const double alone = t.turned - t.order * middle;
    strange_[t.at] += kForget * (alone * alone - strange_[t.at]);
    const double off = std::abs(alone) / t.sd;
    const double weight = 1.0 / (t.sd * t.sd * std::max(1.0, off / kOutlier));
    above += weight * t.order * t.turned;
    below += weight * t.order * t.order;
    apart += std::min(off, kMostApart);
  }
  // Of a normal distribution the mean of |x| is 0.8.
  const double spread = std::max(1.0, apart / (0.8 * static_cast<double>(turned_.size())));
  const double per_block = 1.0 / (kTurn * block_rev_);
  return {.off = above / below * per_block,
          .variance = spread * spread / below * per_block * per_block,
          .known = true};
}

void SpindleTrack::follow(const Fit& found, double seconds, bool loud) noexcept {
  const double walk = kWalk * kWalk * seconds;
  if (!found.known) {
    // In air, or where lines beside the orders hide them.
    behind_ -= kLag * behind_;
    const double lost = loud ? kLost * kLost * seconds : walk;
    const double most = std::min(kInAir, kMoreInAir * told_sd_);
    variance_ = std::max(variance_, std::min(variance_ + lost, most * most));
    return;
  }
  const double innovation = found.off * found.off;
  const double usual = variance_ + walk + found.variance;
  strays_ = innovation > kSigmas2 * usual ? strays_ + 1 : 0;
  if (strays_ > 0 && strays_ < kFewStrays) {
    return;
  }
  behind_ += kLag * (found.off - behind_);
  restless_ += (innovation / usual - restless_) / kRestlessBlocks;
  const double prior = variance_ + walk * std::clamp(restless_ * restless_, 1.0, kMostRestless);
  const double gain = std::min(kMostGain, prior / (prior + found.variance));
  off_ = std::clamp(off_ + gain * found.off, -kMost, kMost);
  variance_ = std::clamp((1.0 - gain) * prior, kLeastVariance, kMost * kMost);
}

void SpindleTrack::reset() noexcept {
  off_ = 0.0;
  variance_ = told_sd_ * told_sd_;
  restless_ = 1.0;
  behind_ = 0.0;
  strays_ = 0;
  std::ranges::fill(strange_, kUnknownStrange);
  started_ = comparable_ = false;
}

}  // namespace steadyrest::chatter::online
