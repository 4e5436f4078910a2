// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::passport {

/// Servo values of one axis, and the comments behind them; a comment is printable text on one line.
struct ServoValues {
  std::string axis;
  double gain_1_s = 0.0;
  double feed_forward = 0.0;
  std::string gain_comment;
  std::string feed_forward_comment;
};

/// The machine file with servo_gain_… and feed_forward of these axes replaced; a missing
/// feed_forward is added behind the gain. The gain stays in the unit that the file has it in. The
/// comment of a replaced line goes with the value that it spoke of; every other byte stays, and the
/// result is read back. Refused: a machine file that is faulty, lacks an axis, or has it in a form
/// without lines (inline table, dotted keys).
[[nodiscard]] kernel::outcome::Result<std::string> with_servo(
    std::string_view text, const std::string& file, const std::vector<ServoValues>& values);

}  // namespace steadyrest::passport
