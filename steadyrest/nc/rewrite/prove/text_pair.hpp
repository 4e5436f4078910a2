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
  std::string head;                  ///< the text of the head's lines
  std::size_t head_lines = 0;
  /// The text of the others, by the line of the original that they precede.
  std::map<std::uint32_t, std::string> groups;
};

/// Compares two programs byte by byte, ignoring the inserted lines of `changed`. Refused at the
/// first other difference, where an inserted line's end differs from those around it, and where the
/// head is not the plan's or is in the wrong place: running the program would not show that.
/// `plain` sees the original's lines on the way.
[[nodiscard]] kernel::outcome::Result<Inserted> compare_text(const std::string& original,
                                                             const std::string& changed,
                                                             PlainSurvey& plain, const Plan& plan,
                                                             const Settings& settings);

}  // namespace steadyrest::nc::rewrite
