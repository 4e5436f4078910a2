// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/contour/offline/learn/learn_from.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Parts cut before, whose records a verb learns from.
namespace steadyrest::apps::cli {

struct LearningOptions {
  std::vector<std::string> records;
  std::vector<std::string> programs;  ///< that each record was made with; empty: the program itself
};

/// Adds --from-record and --cut-program.
void add_learning_options(Verb& verb, LearningOptions& options);

/// Reads the records. Refused: what read_part_record() refuses, and other than one --cut-program
/// for each record.
[[nodiscard]] kernel::outcome::Result<std::vector<contour::offline::CutPart>> read_parts(
    const LearningOptions& options, const std::string& program);

/// The key `learnt[]`, and its text for people; empty without records. What the next part has
/// is said of a program that has `changed` alone.
[[nodiscard]] std::string put_learnt(Answer& answer, const LearningOptions& options,
                                     const std::vector<contour::offline::LearningFigures>& learnt,
                                     bool changed);

}  // namespace steadyrest::apps::cli
