// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/motion/online/estimator/estimator.hpp>

namespace steadyrest::motion::offline {

/// Writes estimates as CSV as they are made. Columns
/// `t_s,position_mm,velocity_mm_s,acceleration_mm_s2,velocity_bound_mm_s,acceleration_bound_mm_s2`;
/// t_s with nine decimals, the others with the digits that give back the same double, `inf` where
/// there is no bound.
class EstimateTable {
 public:
  /// The caller keeps the file and commits it.
  explicit EstimateTable(kernel::file::OutputFile& out);
  void put(const online::Estimate& estimate);
  /// Writes out whatever is still buffered.
  void finish();

 private:
  kernel::file::OutputFile& out_;
  std::string buffer_;
};

}  // namespace steadyrest::motion::offline
