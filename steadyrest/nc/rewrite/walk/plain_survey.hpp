// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include <steadyrest/nc/interpret/decode/dialect_rules.hpp>
#include <steadyrest/nc/read/reader.hpp>
#include <steadyrest/nc/rewrite/walk/survey.hpp>

namespace steadyrest::nc::rewrite {

/// The survey of a program whose text alone shows that each line is executed once, in order: found
/// while the text is read for other reasons.
///
/// A plain program is one of dialect linuxcnc with nothing outside comments but `%` and words of a
/// letter and a literal number; no O, none of M97, M98, M99, no mark `/`, no parameter, no
/// expression. The number of M must be whole. With anything else a program is not plain, and
/// survey() runs it.
class PlainSurvey {
 public:
  explicit PlainSurvey(read::Dialect dialect) noexcept
      : plain_(interpret::rules_of(dialect).plain_words) {}

  /// Takes the next line. True if it certainly holds no comment.
  bool look(std::string_view line);
  /// None when the program is not plain.
  [[nodiscard]] std::optional<Survey> take() {
    return plain_ ? std::optional(std::move(survey_)) : std::nullopt;
  }

 private:
  bool code(std::string_view line, std::size_t& at);

  bool plain_;
  std::uint32_t line_ = 0;
  std::uint32_t changed_at_ = 0;
  Survey survey_;
};

/// The result of `plain`, else of running the program. A plain program is not run: what the
/// interpreter refuses shows when it is walked.
[[nodiscard]] kernel::outcome::Result<Survey> survey(const std::string& path,
                                                     const interpret::Config& config,
                                                     PlainSurvey& plain);

}  // namespace steadyrest::nc::rewrite
