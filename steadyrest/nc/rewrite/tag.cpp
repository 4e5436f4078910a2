// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/read/line_source.hpp>
#include <steadyrest/nc/rewrite/file_writer.hpp>
#include <steadyrest/nc/rewrite/source_lines.hpp>
#include <steadyrest/nc/rewrite/tag.hpp>

namespace steadyrest::nc::rewrite {

bool is_inserted(std::string_view line) noexcept {
  for (std::size_t at = line.find(kTag); at != std::string_view::npos;
       at = line.find(kTag, at + 1)) {
    const std::string_view before = line.substr(0, at);
    if (before.ends_with('(') || before.ends_with("(ABORT,") || before.ends_with(';')) {
      return true;
    }
  }
  return false;
}

bool is_head(std::string_view inserted_line) noexcept {
  return inserted_line.find("(STEADYREST head ") != std::string_view::npos ||
         inserted_line.find(";STEADYREST head ") != std::string_view::npos ||
         inserted_line.find("(ABORT,STEADYREST ") != std::string_view::npos;
}

kernel::outcome::Result<std::size_t> strip(const std::string& program, const std::string& output) {
  auto lines = SourceLines::open(program);
  if (!lines) {
    return std::unexpected(lines.error());
  }
  auto writer = FileWriter::open(output);
  if (!writer) {
    return std::unexpected(writer.error());
  }
  std::size_t removed = 0;
  while (lines->next()) {
    if (is_inserted(lines->line())) {
      ++removed;
    } else {
      writer->write(lines->line());
      writer->write(lines->ending());
    }
  }
  if (auto whole = lines->whole(); !whole) {
    return std::unexpected(whole.error());
  }
  if (auto written = writer->commit(); !written) {
    return std::unexpected(written.error());
  }
  return removed;
}

}  // namespace steadyrest::nc::rewrite
