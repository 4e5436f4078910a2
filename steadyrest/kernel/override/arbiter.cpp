// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/kernel/override/arbiter.hpp>

// Feed: the lowest wish, since each room knows only its own limit and the lowest keeps them all.
// Spindle: chatter's, else the smallest change. Offsets: the sum, since each wish corrects a
// different error of the same axis.
namespace steadyrest::kernel::override {
namespace {

using outcome::Reason;

/// The more serious of two reasons to do nothing: a fault before a withdrawal before none.
Reason graver(Reason a, Reason b) noexcept {
  if (a == Reason::none || b == Reason::none) {
    return a == Reason::none ? b : a;
  }
  // Lower numbers are more serious: input faults come before withdrawals.
  return std::min(a, b);
}

// An unfit ratio becomes neutral before any comparison: NaN neither wins nor loses one.
template <class Request>
Request made_fit(Request request) noexcept {
  if (const Reason fault = fault_of(request.ratio); fault != Reason::none) {
    request.ratio = 1.0;
    request.reason = fault;
  }
  return request;
}

// Only while there is no wish: a wish always beats a withdrawal.
template <class Request>
void withdraw(Request& decision, const Request& request) noexcept {
  const Reason reason = graver(decision.reason, request.reason);
  if (reason != decision.reason) {
    decision = {.room = request.room, .ratio = 1.0, .reason = reason};
  }
}

bool beats(const signal::FeedRequest& challenger, const signal::FeedRequest& holder) {
  return challenger.ratio < holder.ratio;
}

bool beats(const signal::SpindleRequest& challenger, const signal::SpindleRequest& holder) {
  const bool chatter = challenger.room == signal::Room::chatter;
  // Stability hangs on the exact speed: a compromise with another room would serve neither.
  if (chatter != (holder.room == signal::Room::chatter)) {
    return chatter;
  }
  return std::abs(challenger.ratio - 1.0) < std::abs(holder.ratio - 1.0);
}

}  // namespace

Reason fault_of(double ratio) noexcept {
  if (!std::isfinite(ratio)) {
    return Reason::input_not_finite;
  }
  return ratio < 0.0 || ratio > kMaxRequestRatio ? Reason::input_out_of_range : Reason::none;
}

template <class Request>
void RatioArbiter<Request>::add(const Request& request) noexcept {
  const Request fit = made_fit(request);
  if (is_wish(fit.ratio, fit.reason)) {
    if (wishes_ == 0 || beats(fit, decision_)) {
      decision_ = fit;
    }
    ++wishes_;
  } else if (wishes_ == 0) {
    withdraw(decision_, fit);
  }
}

template class RatioArbiter<signal::FeedRequest>;
template class RatioArbiter<signal::SpindleRequest>;

// Each axis takes the slowest slope. One unfit summand makes the whole sum unknown: half a
// correction may be worse than none.
void OffsetArbiter::add(const signal::OffsetRequest& request) noexcept {
  // Even from an unfit request: assuming the tool in the cut is the safe side.
  sum_.tool_in_cut = sum_.tool_in_cut || request.tool_in_cut;
  if (!std::ranges::all_of(request.offset_mm, [](double mm) { return std::isfinite(mm); })) {
    withdrawn_ = graver(withdrawn_, Reason::input_not_finite);
    return;
  }
  if (!std::ranges::all_of(request.slope_mm_s, [](double mm_s) { return mm_s >= 0.0; })) {
    withdrawn_ = graver(withdrawn_, Reason::input_out_of_range);
    return;
  }
  if (!is_wish(request.reason)) {
    withdrawn_ = graver(withdrawn_, request.reason);
    return;
  }
  if (sum_.reason == Reason::none) {
    sum_.room = request.room;
    sum_.reason = request.reason;
  }
  for (std::size_t axis = 0; axis < signal::kMaxAxes; ++axis) {
    sum_.offset_mm[axis] += request.offset_mm[axis];
    sum_.slope_mm_s[axis] = std::min(sum_.slope_mm_s[axis], request.slope_mm_s[axis]);
  }
}

void OffsetArbiter::add(std::span<const signal::OffsetRequest> requests) noexcept {
  for (const auto& request : requests) {
    add(request);
  }
}

signal::OffsetRequest OffsetArbiter::decision() const noexcept {
  signal::OffsetRequest decision = sum_;
  if (!std::ranges::all_of(sum_.offset_mm, [](double mm) { return std::isfinite(mm); })) {
    // Finite summands may overflow.
    decision.reason = Reason::input_out_of_range;
  } else if (withdrawn_ != Reason::none) {
    decision.reason = withdrawn_;
  }
  if (!is_wish(decision.reason)) {
    decision.offset_mm = {};
  }
  return decision;
}

}  // namespace steadyrest::kernel::override
