// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/chatter/offline/process/speed_profile.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::chatter::offline {

/// The course of the spindle's speed over one period of a law as this machine makes it, not as the
/// law has it.
///
/// The modulator itself, the envelope and the hand-over write the words, in cycles of about 2 ms;
/// the control scans each override and acts its dead time later, the feed follows within its band
/// and the spindle's drive accelerates at its constant limit. Taken is one period after all has
/// settled, with the operator's switch at its highest step. Scan and cycle are fitted to the period
/// by at most a sixteenth, so that the course repeats; power and torque limits of the drive are
/// left out. Refuses what the modulator refuses, and a word that cannot be walked safely.
[[nodiscard]] kernel::outcome::Result<std::vector<SpeedRamp>> override_course(
    const kernel::machine::Machine& machine, double programmed_rev_s, const Modulation& modulation);

}  // namespace steadyrest::chatter::offline
