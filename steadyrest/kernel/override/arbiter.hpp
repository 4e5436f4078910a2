// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/signal/request.hpp>

/// Combines the rooms' requests into one, with the winner's reason.
///
/// Law of reasons: a reason from a room's own range (≥ 200) makes the request a *wish*; `none` and
/// the common reasons (below 100) mean that the room has nothing to ask or has withdrawn. A ratio
/// below 1 counts as a wish whatever its reason.
///
///   feed     the lowest wish wins: each room's limit is kept.
///   spindle  chatter's wish wins, since stability depends on the exact speed and a mean of two
///            serves neither; among other rooms the wish nearest to 1.
///   offset   wishes add, axis by axis, and the slowest slope holds; the clamp is the envelope's.
///            One withdrawn or unfit summand makes the sum unknown, so the envelope freezes. A
///            slope that is NaN or negative is unfit.
///
/// A ratio that is not finite, negative or above kMaxRequestRatio is unfit: that request becomes
/// neutral and carries the reason. O(1) per request, noexcept, without allocation.
namespace steadyrest::kernel::override {

inline constexpr double kMaxRequestRatio = 10.0;  ///< five times what a control accepts

/// The reason marks a request for something.
[[nodiscard]] constexpr bool is_wish(outcome::Reason reason) noexcept {
  return static_cast<unsigned>(reason) >= 200;
}
/// The same for a ratio: lower than 1 is always a wish.
[[nodiscard]] constexpr bool is_wish(double ratio, outcome::Reason reason) noexcept {
  return ratio < 1.0 || is_wish(reason);
}
/// none, input_not_finite or input_out_of_range.
[[nodiscard]] outcome::Reason fault_of(double ratio) noexcept;

/// Of the requests for one override: the lowest for the feed, see above for the spindle.
template <class Request>
class RatioArbiter {
 public:
  void add(const Request& request) noexcept;
  void add(std::span<const Request> requests) noexcept {
    for (const Request& request : requests) {
      add(request);
    }
  }
  /// The winning wish; without one, neutral with the reason of the most serious withdrawal.
  [[nodiscard]] const Request& decision() const noexcept { return decision_; }
  /// Number of wishes; all but one were outvoted or agreed.
  [[nodiscard]] unsigned wishes() const noexcept { return wishes_; }

 private:
  Request decision_;
  unsigned wishes_ = 0;
};
using FeedArbiter = RatioArbiter<signal::FeedRequest>;
using SpindleArbiter = RatioArbiter<signal::SpindleRequest>;

class OffsetArbiter {
 public:
  void add(const signal::OffsetRequest& request) noexcept;
  void add(std::span<const signal::OffsetRequest> requests) noexcept;
  /// The sum. Its reason is the first wish's; a reason below 200 other than `none` means that the
  /// sum is unknown. `tool_in_cut` when any room says so.
  [[nodiscard]] signal::OffsetRequest decision() const noexcept;

 private:
  signal::OffsetRequest sum_;
  outcome::Reason withdrawn_ = outcome::Reason::none;
};

}  // namespace steadyrest::kernel::override
