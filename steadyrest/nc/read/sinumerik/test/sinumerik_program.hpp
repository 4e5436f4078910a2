// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/nc/read/reader.hpp>
#include <steadyrest/nc/read/test/map_values.hpp>

namespace steadyrest::nc::read::test {

/// Lines of a SINUMERIK program, with the variables that they set.
class SinumerikProgram {
 public:
  SinumerikProgram() { reader_.set_typed_values(&values); }
  /// The block of a line that must be accepted.
  const Block& block(std::string line) {
    text_ = std::move(line);
    EXPECT_TRUE(reader_.read(text_, 2, 1, block_)) << text_ << ": " << reader_.refused().text;
    return block_;
  }
  /// The reason why a line is refused; empty when it is not.
  std::string fault(std::string line) {
    text_ = std::move(line);
    return reader_.read(text_, 2, 1, block_) ? "" : reader_.refused().reason;
  }
  MapValues values;

 private:
  std::string text_;
  Reader reader_{Dialect::sinumerik};
  Block block_;
};

}  // namespace steadyrest::nc::read::test
