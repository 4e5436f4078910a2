// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

#include <steadyrest/motion/online/estimator.hpp>

namespace steadyrest::motion::offline {

/// Writes estimates as CSV while they arise. Columns
/// `t_s,position_mm,velocity_mm_s,acceleration_mm_s2,velocity_bound_mm_s,acceleration_bound_mm_s2`;
/// t_s with nine decimals, the others with the digits that give back the same double, `inf` where
/// there is no bound.
class EstimateTable {
 public:
  explicit EstimateTable(std::FILE* out);
  void put(const online::Estimate& estimate);
  /// Writes what is left. False when anything could not be written.
  [[nodiscard]] bool finish();

 private:
  void flush();

  std::FILE* out_;
  std::string buffer_;
  bool good_ = true;
};

}  // namespace steadyrest::motion::offline
