// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/contour/offline/learn/learn_from.hpp>
#include <steadyrest/contour/offline/predistort/text/changed_text.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::contour::offline {

/// The programs that parts were cut with, beside a new one.
struct BestPartTask {
  const std::string& file;  ///< the original
  const Lessons& lessons;   ///< of the model that the new one is made with
  const std::vector<CutPart>& parts;
  const std::vector<nc::rewrite::Told>& told;
};

struct BestPart {
  std::size_t part = 0;
  Changed program;
  double largest_shift_mm = 0.0;  ///< of its cuts, from the original
};

/// The program of the best part so far, where the new one is not surely better.
///
/// Law. By its record a part's program leaves d̂ + Q·(d − d̂) where the record has shown it. On a
/// machine whose model says d̂ᵢ, and which made the same record, the new program leaves
/// d̂ᵢ(new) + Q·(d − d̂ᵢ). It is better where neither the RMS nor the largest of that grows (the
/// largest may where the RMS is halved), on the model or on any that explains the record half as
/// well: gains to both sides of the uncertainty, lags of a quarter and half of 1/k. The noise of
/// the record is in both and counts in neither.
///
/// Parts whose program was not made from the original, or was edited, are passed over. Refused:
/// what learn_from() and the planner refuse.
[[nodiscard]] kernel::outcome::Result<std::optional<BestPart>> better_part(const BestPartTask& task,
                                                                           const Changed& made);

}  // namespace steadyrest::contour::offline
