// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/rewrite/text/source_lines.hpp>

namespace steadyrest::nc::rewrite {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

// The raw text of the file, for copying and comparing: lines with their own ends, no words.
Result<SourceLines> SourceLines::open(const std::string& path) {
  auto source = read::LineSource::open(path);
  if (!source) {
    return std::unexpected(source.error());
  }
  return SourceLines(std::move(*source), path);
}

SourceLines SourceLines::of(std::string_view text, std::string path) {
  return {read::LineSource::from_text(text), std::move(path)};
}

// A program must be read to its end: otherwise half a file would be proved as if it were whole.
Result<void> SourceLines::whole() const {
  if (status_ == read::LineSource::Status::end) {
    return {};
  }
  const bool too_long = status_ == read::LineSource::Status::too_long;
  return std::unexpected(Refusal{too_long ? Kind::bad_input : Kind::unavailable, path_,
                                 source_.number(),
                                 too_long ? "a line of more than 65536 bytes" : "cannot be read on",
                                 too_long ? "give the text of an NC program" : "check the disk"});
}

}  // namespace steadyrest::nc::rewrite
