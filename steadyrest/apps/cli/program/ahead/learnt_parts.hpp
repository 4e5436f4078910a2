// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/contour/offline/predistort/predistort.hpp>
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

/// The keys `learnt[]`, `fitted[]` and `kept_part`, and their text for people; empty without
/// records.
[[nodiscard]] std::string put_learnt(Answer& answer, const LearningOptions& options,
                                     const contour::offline::Predistorted& done);

}  // namespace steadyrest::apps::cli
