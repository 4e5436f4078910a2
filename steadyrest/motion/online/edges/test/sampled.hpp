// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Samples of the two levels of an encoder.
namespace steadyrest::motion::online::test {

struct Sample {
  bool a = false;
  bool b = false;
  std::uint64_t t = 0;
};

/// Levels in a cell: 00, 10, 11, 01 for cells 0, 1, 2, 3 (mod 4).
/// Gray code of two bits: one level changes from cell to cell.
inline Sample in_cell(std::int64_t cell, std::uint64_t t) {
  const auto place = static_cast<unsigned>(cell) & 3U;
  return {place == 1U || place == 2U, place >= 2U, t};
}

}  // namespace steadyrest::motion::online::test
