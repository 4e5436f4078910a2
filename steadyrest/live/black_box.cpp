// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/live/black_box.hpp>

namespace steadyrest::live {

using kernel::outcome::Reason;

namespace {

/// Those of the supervisor's check.
std::string_view reason_of(Reason unfit) noexcept {
  switch (unfit) {
    case Reason::input_stale:
      return "kept: the input was stale";
    case Reason::input_not_finite:
      return "kept: the input was not finite";
    default:
      return "kept: the input was out of range";
  }
}

}  // namespace

/// Windows follow one another: a burst of up to twice `burst` may lie across two of them unseen.
bool BlackBox::bursts(const Cycle& cycle) noexcept {
  if (!begun_ || cycle.now_s - window_s_ >= config_.burst_s) {
    begun_ = true;
    window_s_ = cycle.now_s;
    window_overruns_ = cycle.overruns;
  }
  return cycle.overruns - window_overruns_ >= config_.burst;
}

bool BlackBox::begins(Kind& kind, bool present, double now_s) const noexcept {
  const bool told =
      present && !kind.present && !(kind.told && now_s - kind.told_s < config_.apart_s);
  kind.present = present;
  if (told) {
    kind.told = true;
    kind.told_s = now_s;
  }
  return told;
}

// All kinds are looked at in each cycle; the gravest gives the words.
std::string_view BlackBox::update(const Cycle& cycle) noexcept {
  const bool burst = begins(burst_, bursts(cycle), cycle.now_s);
  const bool unfit = begins(unfit_, cycle.unfit != Reason::none, cycle.now_s);
  if (begins(port_, cycle.port_fault, cycle.now_s)) {
    return "kept: the port could not be read or written";
  }
  if (unfit) {
    return reason_of(cycle.unfit);
  }
  return burst ? "kept: a burst of overruns" : std::string_view();
}

}  // namespace steadyrest::live
