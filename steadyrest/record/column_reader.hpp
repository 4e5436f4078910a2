// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/record/database.hpp>

namespace steadyrest::record {

/// Some columns of a record, any chunk of it: what is not asked for is neither read nor unpacked.
/// For figures over a long run; RecordReader gives whole samples.
class ColumnReader {
 public:
  struct Chunk {
    std::int64_t number = 0;
    std::uint64_t first_cycle = 0;  ///< of the control
    std::size_t samples = 0;
  };

  /// `names`: of columns that hold doubles (columns.hpp). Refuses what RecordReader does.
  static kernel::outcome::Result<ColumnReader> open(const std::string& file,
                                                    std::vector<std::string> names);

  /// Of the record as it was when it was opened, in order.
  [[nodiscard]] std::span<const Chunk> chunks() const noexcept { return chunks_; }
  [[nodiscard]] double cycle_s() const noexcept { return cycle_s_; }
  /// The columns of `chunks()[index]`. Refuses damaged data and a column that is not there.
  kernel::outcome::Result<void> read(std::size_t index);
  /// What was read last, in the order of `names`.
  [[nodiscard]] std::span<const double> column(std::size_t at) const noexcept {
    return values_[at];
  }

 private:
  ColumnReader(Database database, Statement data, std::string file, std::vector<std::string> names);
  kernel::outcome::Result<void> read_chunks();

  std::string file_;
  Database database_;
  Statement data_;
  std::vector<std::string> names_;
  std::vector<Chunk> chunks_;
  std::vector<std::vector<double>> values_;  ///< by column
  double cycle_s_ = 0.0;
};

}  // namespace steadyrest::record
