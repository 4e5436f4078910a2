// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <istream>
#include <string>

#include <steadyrest/apps/cli/machine/servo_log.hpp>

namespace steadyrest::apps::cli {

/// A table of columns, read line by line: that of a run is large, and most of it is of no use here.
[[nodiscard]] kernel::outcome::Result<RecordedServos> servo_table(const std::string& file,
                                                                  std::istream& in,
                                                                  const ServoSource& source);

}  // namespace steadyrest::apps::cli
