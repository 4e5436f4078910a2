// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::passport {

/// A key of a machine file and its new value.
struct NewValue {
  std::string section;  ///< `contour`, `override.feed`; not one of several ([[axis]])
  std::string key;
  std::string value;  ///< as TOML: `12.5`, `"feed_priority"`
};

/// The text with these values; a missing key is added at the top of its section, a missing section
/// at the end. Comments and every other byte stay, and the result is read back. Whether a value is
/// allowed is for the reader (parse()). Refused: a text that is no TOML, a section in a form
/// that is not one key in each line (inline table, dotted keys), an invalid value.
[[nodiscard]] kernel::outcome::Result<std::string> with_keys(std::string_view text,
                                                             const std::string& file,
                                                             const std::vector<NewValue>& values);

}  // namespace steadyrest::passport
