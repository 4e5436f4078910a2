// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace steadyrest::test {

/// An option of a verb that makes files.
struct OutputOption {
  std::string flag;                ///< as in --help
  std::string value;               ///< given in the test
  std::vector<std::string> files;  ///< what is written then
};

/// A verb with everything it reads and writes. Every verb whose --help has an OUT or a DIR must
/// have a row with all of them.
struct OutputRow {
  std::string verb;
  std::string
      arguments;  ///< without the outputs; paths within a folder that has a copy of examples/
  std::vector<OutputOption> outputs;
  std::vector<std::string> inputs;
  bool timed = false;  ///< its files hold how long something took
};

[[nodiscard]] std::span<const OutputRow> output_rows();

/// How GoogleTest shows a row, and what it calls its tests.
void PrintTo(const OutputRow& row, std::ostream* out);
[[nodiscard]] std::string test_name(const testing::TestParamInfo<OutputRow>& info);

}  // namespace steadyrest::test
