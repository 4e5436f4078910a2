// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::chatter::offline {

/// The spindle's speed in rev/min in the name of a recording's file, by a pattern: `{rpm}` is a
/// whole number in the name, which may have decimals behind a point, `*` is anything; the rest must
/// be as it is. `S{rpm}_f*.csv` finds 5000 in `S5000_f300.csv`. Refused: a pattern without `{rpm}`
/// or with two, a name that does not fit, one that fits with several numbers, a speed of 0.
[[nodiscard]] kernel::outcome::Result<double> speed_rpm_in_name(std::string_view path,
                                                                std::string_view pattern);

}  // namespace steadyrest::chatter::offline
