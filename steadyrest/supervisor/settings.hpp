// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/override/channel.hpp>
#include <steadyrest/kernel/override/envelope.hpp>
#include <steadyrest/kernel/port/port.hpp>

/// The machine file's settings for the last step before any write, in the form the envelopes take.
namespace steadyrest::supervisor {

[[nodiscard]] kernel::override::Channel::Config feed_config(
    const kernel::machine::Machine& machine, const kernel::port::Capability& capability);
[[nodiscard]] kernel::override::Channel::Config spindle_config(
    const kernel::machine::Machine& machine, const kernel::port::Capability& capability);
/// Rotary axes take none: the machine file limits offsets in mm only.
[[nodiscard]] kernel::override::OffsetEnvelope::Config offset_config(
    const kernel::machine::Machine& machine, bool available);
/// Of the contour room's offsets.
[[nodiscard]] kernel::override::OffsetEnvelope::Config path_offset_config(
    const kernel::machine::Machine& machine, bool available);

/// How long it may take until nothing of the layer is left on a machine that stands, s: the longest
/// way by the slews, a walk over every step of a word that is not latched, the second until a
/// machine at rest counts as out of the cut.
[[nodiscard]] double longest_hand_back_s(const kernel::machine::Machine& machine) noexcept;

}  // namespace steadyrest::supervisor
