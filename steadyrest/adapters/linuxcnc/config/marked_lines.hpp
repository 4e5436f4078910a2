// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

/// Lines put into a file of the user's so that they can be taken out again, byte for byte:
///
///     # steadyrest begin 1a2b3c4d: `steadyrest linuxcnc setup FILE --undo` takes this out
///     # was: the line that is replaced
///     the new line
///     # steadyrest end
///
/// The number is a checksum of the lines between: an edit there shows, edits elsewhere stay.
namespace steadyrest::adapters::linuxcnc::config {

/// In place of lines `first` … `first` + `removed` − 1 (1-based) come these, without line ends.
struct Edit {
  std::size_t first = 1;
  std::size_t removed = 0;
  std::vector<std::string> added;
};

/// The text with each edit as a marked block; edits rise and do not touch.
[[nodiscard]] std::string with_blocks(std::string_view text, const std::vector<Edit>& edits,
                                      const std::string& ini_name);

/// The text without blocks, and what was in them.
struct Unmarked {
  std::string text;
  std::vector<std::string> added;  ///< the lines that were taken out, without line ends
  std::size_t blocks = 0;          ///< that were taken out
};
/// Blocks of another INI file's setup stay. Refused: a block that was edited or has lost its begin
/// or its end.
[[nodiscard]] kernel::outcome::Result<Unmarked> without_blocks(std::string_view text,
                                                               const std::string& file,
                                                               const std::string& ini_name);

/// The line of the first block; 0: none.
[[nodiscard]] std::size_t first_block(std::string_view text);

/// A file of our own: its first line has the checksum of the rest.
[[nodiscard]] std::string own_file(std::string_view text, const std::string& ini_name);
enum class Own { no, yes, edited };
[[nodiscard]] Own is_own_file(std::string_view text);

}  // namespace steadyrest::adapters::linuxcnc::config
