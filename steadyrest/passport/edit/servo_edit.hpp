// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
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
  // Designated initialisers may leave it out.
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::optional<double> velocity_lag_s = std::nullopt;  ///< none: the file's own
  // NOLINTNEXTLINE(readability-redundant-member-init)
  std::string velocity_lag_comment = {};
};

/// The machine file with servo_gain_…, feed_forward and velocity_lag_ms of these axes replaced; a
/// missing feed_forward or velocity_lag_ms is added behind the gain. Without a lag the file's
/// own stays. The gain stays in the unit that the file has it in. The
/// comment of a replaced line goes with the value that it spoke of; every other byte stays, and the
/// result is read back. Refused: a machine file that is faulty, lacks an axis, or has it in a form
/// without lines (inline table, dotted keys).
[[nodiscard]] kernel::outcome::Result<std::string> with_servo(
    std::string_view text, const std::string& file, const std::vector<ServoValues>& values);

}  // namespace steadyrest::passport
