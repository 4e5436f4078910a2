// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

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

// A limit of 0 means that the axis takes no offset: rotary axes, and ports that cannot write one.
OffsetEnvelope::Config offset_config(const machine::Machine& machine, bool available) {
  OffsetEnvelope::Config config{.max_mm = {},
                                .slew_mm_s = machine.envelope.offset_slew_mm_s,
                                .max_step_s = machine.envelope.stale_after_s};
  for (std::size_t i = 0; i < std::min(machine.axes.size(), config.max_mm.size()); ++i) {
    config.max_mm[i] = available && !machine.axes[i].rotary ? machine.envelope.max_offset_mm : 0.0;
  }
  return config;
}

}  // namespace steadyrest::supervisor
