// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

/// Whether a recording is of the spindle speed and the cutter that are said of it.
namespace steadyrest::chatter::offline {

struct OrderFindings {
  bool known = false;        ///< its orders stand out
  double speed_rev_s = 0.0;  ///< whose orders explain the lines best, within ±25 % of what is said
  double told_share = 0.0;   ///< of the lines' energy at orders of the speed that is said (±2 %)
  double found_share = 0.0;  ///< the same of `speed_rev_s`
  bool other_speed = false;  ///< that is not what is said
  std::size_t other_teeth = 0;  ///< 0: the orders do not contradict the teeth that are said
};

/// Law. P is the mean power spectrum of windows of about 2 s, of the louder half of them. The comb
/// of a speed Ω covers each order k·Ω up to the 40th by one bin and 0.05 % to either side; its
/// share is that of √(P − three medians) within it, less the share of bins that it covers. Another
/// speed is named where it has 0.5 and 0.25 more than every speed within 2 % of what is said. With
/// the better speed, E_k is the energy of that at order k: other teeth are named where multiples of
/// the teeth that are said have less than half of it and those of another number, 2 at least, have
/// 0.8: the largest such number. `told_rev_s` > 0, `rate_hz` > 0; a signal of less than one window
/// is not known.
[[nodiscard]] OrderFindings check_orders(const std::vector<double>& value, double rate_hz,
                                         double told_rev_s, std::size_t teeth);

}  // namespace steadyrest::chatter::offline
