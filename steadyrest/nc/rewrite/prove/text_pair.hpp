// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>
#include <steadyrest/nc/rewrite/text/settings.hpp>
#include <steadyrest/nc/rewrite/walk/plain_survey.hpp>

namespace steadyrest::nc::rewrite {

/// The inserted lines of a changed program.
struct Inserted {
  std::vector<std::uint32_t> lines;  ///< their numbers
  std::string head;                  ///< the text of those of the head, one under the other
  std::size_t head_lines = 0;
  /// The others, by the line of the original before which they stand, one under the other.
  std::map<std::uint32_t, std::string> groups;
};

/// Compares two programs byte by byte, inserted lines of `changed` left out. Refused at the first
/// line that differs otherwise, where an inserted one ends otherwise than the lines around it, and
/// where the head is not that of the plan or stands elsewhere than it belongs: it changes nothing
/// in a run from the beginning to the end. `plain` looks at the original's lines on the way.
[[nodiscard]] kernel::outcome::Result<Inserted> compare_text(const std::string& original,
                                                             const std::string& changed,
                                                             PlainSurvey& plain, const Plan& plan,
                                                             const Settings& settings);

}  // namespace steadyrest::nc::rewrite
