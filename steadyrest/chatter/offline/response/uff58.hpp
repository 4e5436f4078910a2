// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/chatter/offline/response/frf.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Universal file format, dataset 58 (function at nodal degree of freedom): what tap-test programs
/// write, as text or in the binary form 58b.
///
/// Of the frequency responses (function type 4) those of the drive point are taken: response and
/// force at one node, along one line. A direction with a minus on one side reverses the sign. The
/// coherence of the same points is used; other functions are skipped. Both with a note. Complex,
/// single or double, with even or uneven abscissa in Hz, kHz, rad/s or rpm; displacement, velocity
/// (divided by iω) or acceleration (by −ω²) over force, in the units of the labels, of dataset 164
/// or SI (uff_units.hpp). Source: SDRC Universal File Datasets Summary, datasets 58, 58b, 164.
namespace steadyrest::chatter::offline {

/// The responses of the text; the notes are with the first. Refused by line: a truncated text, no
/// response, none at its own point, drive points of several places or directions, numbers that are
/// not complex or not IEEE, unknown units.
[[nodiscard]] kernel::outcome::Result<std::vector<Frf>> parse_uff58(std::string_view text,
                                                                    const std::string& file);

}  // namespace steadyrest::chatter::offline
