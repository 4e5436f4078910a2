// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/supervisor/settings.hpp>

// From the machine file and the port to the envelopes' settings. Feed may fall faster than it
// rises: slowing down protects, speeding up surprises. The spindle has one slew for both
// directions, since its drive works as hard in either. The longest step credited to a slew is the
// watchdog's time; beyond it the machine has dropped the word.
namespace steadyrest::supervisor {

namespace machine = kernel::machine;
using kernel::override::Channel;
using kernel::override::OffsetEnvelope;

Channel::Config feed_config(const machine::Machine& machine,
                            const kernel::port::Capability& capability) {
  return {.table = machine.feed_override,
          .min_ratio = machine.envelope.min_feed_ratio,
          .max_ratio = machine.envelope.max_feed_ratio,
          .fall_1_s = machine.envelope.feed_fall_1_s,
          .rise_1_s = machine.envelope.feed_rise_1_s,
          .max_step_s = machine.envelope.stale_after_s,
          .latched = capability.latched_word,
          .available = capability.feed_override};
}

Channel::Config spindle_config(const machine::Machine& machine,
                               const kernel::port::Capability& capability) {
  return {.table = machine.spindle_override,
          .min_ratio = machine.envelope.min_spindle_ratio,
          .max_ratio = machine.envelope.max_spindle_ratio,
          .fall_1_s = machine.envelope.spindle_slew_1_s,
          .rise_1_s = machine.envelope.spindle_slew_1_s,
          .max_step_s = machine.envelope.stale_after_s,
          .latched = capability.latched_word,
          .available = capability.spindle_override};
}

namespace {

/// Over so long an offset against the contour error ramps out from its limit when it may no longer
/// be asked for: ten servo time constants of a slow axis, so that the ramp itself is followed.
constexpr double kFade_s = 0.2;

// A limit of 0 is how an axis takes no offset: rotary axes, and ports that cannot write one.
kernel::signal::AxisValues limits(const machine::Machine& machine, double max_mm, bool available) {
  kernel::signal::AxisValues limit{};
  for (std::size_t i = 0; i < std::min(machine.axes.size(), limit.size()); ++i) {
    limit[i] = available && !machine.axes[i].rotary ? max_mm : 0.0;
  }
  return limit;
}

}  // namespace

// No faster than an offset against the contour error can give way, also one that a reload is taking
// out: together they keep its limit.
OffsetEnvelope::Config offset_config(const machine::Machine& machine, bool available) {
  const auto& envelope = machine.envelope;
  const double slower_mm_s = std::min(envelope.offset_slew_mm_s, envelope.path_offset_slew_mm_s);
  return {.max_mm = limits(machine, envelope.max_offset_mm, available),
          // A slew that is none must reach make(), which refuses it.
          .slew_mm_s =
              std::isfinite(envelope.offset_slew_mm_s) ? slower_mm_s : envelope.offset_slew_mm_s,
          .max_step_s = machine.envelope.stale_after_s};
}

OffsetEnvelope::Config path_offset_config(const machine::Machine& machine, bool available) {
  const double max_mm = machine.envelope.max_path_offset_mm;
  return {.max_mm = limits(machine, max_mm, available),
          .slew_mm_s = machine.envelope.path_offset_slew_mm_s,
          .fade_mm_s = std::max(max_mm, 1e-3) / kFade_s,
          .max_step_s = machine.envelope.stale_after_s};
}

double longest_hand_back_s(const machine::Machine& machine) noexcept {
  // The port may walk a word that the table calls latched, so the walk always counts.
  const auto way_s = [](const machine::OverrideTable& table, double rise_1_s) {
    const double top = table.ratio.empty() ? 0.0 : std::min(table.ratio.back(), table.max_ratio);
    return std::max(top, 1.0) / rise_1_s +
           static_cast<double>(table.ratio.size() + 2) * table.scan_period_s;
  };
  const auto& envelope = machine.envelope;
  constexpr double kRest_s = 1.0;
  const double offset_s =
      kRest_s + kFade_s + envelope.max_offset_mm / offset_config(machine, true).slew_mm_s;
  return std::max({way_s(machine.feed_override, envelope.feed_rise_1_s),
                   way_s(machine.spindle_override, envelope.spindle_slew_1_s), offset_s});
}

}  // namespace steadyrest::supervisor
