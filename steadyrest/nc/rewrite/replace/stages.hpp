// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/rewrite/replace/replace.hpp>

/// A program whose lines are replaced in several stages, each made for the result of the one
/// before.
namespace steadyrest::nc::rewrite {

/// A program with lines replaced and without any mark: what the next stage is made for.
struct Stage {
  std::string text;
  std::vector<std::uint32_t> origin;  ///< the original's line of each of its lines, from 1
};
[[nodiscard]] kernel::outcome::Result<Stage> with_lines(const std::string& program,
                                                        const NewLines& lines);

/// The new lines of both stages, for the original: `first` by its lines, `second` by those of
/// with_lines(program, first).
[[nodiscard]] NewLines composed(const NewLines& first, const Stage& stage, const NewLines& second);

}  // namespace steadyrest::nc::rewrite
