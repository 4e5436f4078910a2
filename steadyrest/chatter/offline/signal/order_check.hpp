// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

/// Checks a recording against its stated spindle speed and number of teeth.
namespace steadyrest::chatter::offline {

struct OrderFindings {
  bool known = false;        ///< spindle orders rise above the noise
  double speed_rev_s = 0.0;  ///< that explains the lines best
  double told_share = 0.0;   ///< of the lines, at orders of the stated speed (±2 %)
  double found_share = 0.0;  ///< the same for `speed_rev_s`
  bool other_speed = false;  ///< the stated speed is wrong
  std::size_t other_teeth =
      0;  ///< number of teeth that fits instead; 0: the stated one may be right
};

/// Law. P is the mean power spectrum of windows of about 2 s, taken over the louder half of them.
/// The comb of a speed Ω covers each order k·Ω up to the 40th with one bin and 0.05 % on either
/// side. Its share is the part of √(P − three medians) inside it, minus the share of bins that it
/// covers. The stated speed is wrong if another one, between a quarter of it and fourfold (its
/// multiples and parts excepted), has a share of at least 0.5, and 0.25 more than every speed
/// within 2 % of the stated one, resting on at least three orders
/// ((Σ s)²/Σ s²): a single line of chatter is at an order of many a speed. E_k is the energy at
/// order k of the better speed: another number of teeth fits if multiples of the stated one hold
/// less than half of it and multiples of another, 2 at least, hold 0.8; the largest such number is
/// named. `told_rev_s` > 0, `rate_hz` > 0. A signal shorter than one window is not known.
[[nodiscard]] OrderFindings check_orders(std::span<const double> value, double rate_hz,
                                         double told_rev_s, std::size_t teeth);

/// The stated speed, where it is the same throughout within 0.5 %; else 0. Samples that are not
/// finite are passed over.
[[nodiscard]] double constant_speed(std::span<const double> told_rev_s);

/// A part of a recording with a cut that is not the stated one: another tool, or another speed.
struct OtherCut {
  std::size_t begin = 0;  ///< samples
  std::size_t end = 0;
  double told_rev_s = 0.0;
  double speed_rev_s = 0.0;     ///< of the lines; 0: the stated one
  std::size_t other_teeth = 0;  ///< 0: the stated number may be right
};

/// check_orders() for one window after the other, by half of their length. Three in a row that
/// agree (speeds to 1 %; windows that show no orders are passed over) are a part, which reaches to
/// the middle of the gap between it and the next. `told_rev_s`: of each sample, not finite where it
/// is unknown.
[[nodiscard]] std::vector<OtherCut> other_cuts(std::span<const double> value,
                                               std::span<const double> told_rev_s, double rate_hz,
                                               std::size_t teeth);

}  // namespace steadyrest::chatter::offline
