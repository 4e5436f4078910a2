// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/chatter/offline/process/speed_profile.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::chatter::offline {

/// The spindle speed over one period of a law as this machine really runs it.
///
/// The modulator itself, the envelope and the hand-over write the words in cycles of about 2 ms;
/// the control scans each override and acts a dead time later, the feed follows within its band,
/// and the spindle drive accelerates at its constant limit. The result is one period after
/// everything has settled, with the operator's switch at its highest step. Scan and cycle are
/// adjusted to the period by at most a sixteenth, so that the course repeats; power and torque
/// limits of the drive are ignored. Refuses what the modulator refuses, and a word that cannot be
/// walked safely.
[[nodiscard]] kernel::outcome::Result<std::vector<SpeedRamp>> override_course(
    const kernel::machine::Machine& machine, double programmed_rev_s, const Modulation& modulation);

}  // namespace steadyrest::chatter::offline
