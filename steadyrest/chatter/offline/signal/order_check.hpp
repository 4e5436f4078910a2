// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

/// Checks a recording against its stated spindle speed and number of teeth.
namespace steadyrest::chatter::offline {

struct OrderFindings {
  bool known = false;        ///< spindle orders rise above the noise
  double speed_rev_s = 0.0;  ///< that explains the lines best, within ±25 % of the stated one
  double told_share = 0.0;   ///< of the lines, at orders of the stated speed (±2 %)
  double found_share = 0.0;  ///< the same for `speed_rev_s`
  bool other_speed = false;  ///< the stated speed is wrong
  std::size_t other_teeth =
      0;  ///< number of teeth that fits instead; 0: the stated one may be right
};

/// Law. P is the mean power spectrum of windows of about 2 s, taken over the louder half of them.
/// The comb of a speed Ω covers each order k·Ω up to the 40th with one bin and 0.05 % on either
/// side. Its share is the part of √(P − three medians) inside it, minus the share of bins that it
/// covers. The stated speed is wrong if another one has a share of at least 0.5, and 0.25 more than
/// every speed within 2 % of the stated one. E_k is the energy at order k of the better speed:
/// another number of teeth fits if multiples of the stated one hold less than half of it and
/// multiples of another, 2 at least, hold 0.8; the largest such number is named. `told_rev_s` > 0,
/// `rate_hz` > 0. A signal shorter than one window is not known.
[[nodiscard]] OrderFindings check_orders(const std::vector<double>& value, double rate_hz,
                                         double told_rev_s, std::size_t teeth);

}  // namespace steadyrest::chatter::offline
