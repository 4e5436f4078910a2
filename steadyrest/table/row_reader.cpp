// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/table/fields.hpp>
#include <steadyrest/table/row_reader.hpp>
#include <steadyrest/table/stamp.hpp>

// Logs come from many programs with different separators, decimal marks, units and heads. The
// separator is decided when the first row can be compared with the head; decimal marks are proved
// or refused at the end (number.hpp). Anything ambiguous is refused: a log read wrongly does more
// harm than one not read.
namespace steadyrest::table {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t kMostNotes = 20;
constexpr std::size_t kMostColumns = 256;

// Tabs are separators; everything else below 0x20 means that this is not text.
bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t') || byte == 0x7F;
}

}  // namespace

std::expected<double, Fault> Row::number(std::size_t column) const {
  return reader_.numbers().read(fields_[column], reader_.names().name[column], line_);
}

RowReader::RowReader(Format format, Sink& sink)
    : format_(std::move(format)), sink_(sink), numbers_(format_.decimal) {}

// A file that is no text shows it in its first bytes.
std::optional<Fault> RowReader::first_line(std::string_view& text) {
  if (auto fault = fault_of_kind(text)) {
    return fault;
  }
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) {
    text.remove_prefix(kByteOrderMark.size());
  }
  return std::nullopt;
}

// Line by line, so that logs of any length stream through. Comments and blank lines count only for
// the line numbers in refusals.
std::optional<Fault> RowReader::line(std::string_view text) {
  ++line_;
  if (line_ == 1) {
    if (auto fault = first_line(text)) {
      return fault;
    }
  }
  if (text.ends_with('\r')) {
    text.remove_suffix(1);
  }
  if (!is_utf8(text)) {
    converted_ = from_cp1252(text);
    text = converted_;
    if (!std::exchange(conversion_noted_, true)) {
      notes_.push_back({line_, "is not UTF-8", "it is read as Windows' code page 1252"});
    }
  }
  const std::string_view content = trimmed(text);
  if (content.empty() || content.front() == '#') {
    return std::nullopt;
  }
  // LinuxCNC's halsampler writes it into the log.
  if (content == "overrun") {
    return overrun();
  }
  if (!have_names_) {
    return format_.columns.empty() ? take_head(text) : take_named(text);
  }
  return head_given_ ? take_row(text) : behind_head(text);
}

std::optional<Fault> RowReader::overrun() {
  // Rows that count time lose their time there; with sample numbers only samples are missing.
  if (format_.rows_are_samples &&
      std::ranges::find(format_.columns, "sample"sv) == format_.columns.end()) {
    return Fault{line_, "the sampler overran: an unknown number of samples is missing here",
                 "sample with halsampler -t and name its first column sample"};
  }
  if (notes_.size() < kMostNotes) {
    notes_.push_back({line_, "the sampler overran: samples are missing here",
                      "record fewer pins, or give the sampler a deeper FIFO"});
  }
  return std::nullopt;
}

// Kept as text: without the first row the separator is unknown.
std::optional<Fault> RowReader::take_head(std::string_view text) {
  if (text.find('\r') != std::string_view::npos) {
    return Fault{line_, "the lines end with a bare carriage return",
                 "save the log with LF or CR LF as line ends"};
  }
  if (std::ranges::any_of(text, is_control)) {
    return Fault{line_, "the header has control characters: this is not text", "give a text file"};
  }
  const std::string_view first = field_of(text.substr(0, text.find_first_of(",;\t ")));
  if (!first.empty() &&
      (like_a_number(first) || stamp_of(field_of(text.substr(0, text.find_first_of(",;\t")))))) {
    return Fault{line_, fmt::format("there is no header before \"{}\"", shown(text)),
                 "name the columns in a first line without a leading #, or with --columns"};
  }
  head_text_ = std::string(text);
  head_.line = line_;
  have_names_ = true;
  return std::nullopt;
}

/// Splits by the separator: whether there are as many fields as names.
bool RowReader::fits_names(std::string_view text, char separator) {
  split_fields(text, separator, fields_);
  const std::size_t wanted = format_.columns.size();
  const std::size_t found =
      fields_.size() - (fields_.size() > wanted && fields_.back().empty() ? 1 : 0);
  if (found != wanted || separator == ' ') {
    return found == wanted;
  }
  // Two numbers in one field: another mark separates. What a skipped column holds does not matter.
  bool inner_blank = false;
  for (std::size_t i = 0; i < wanted; ++i) {
    inner_blank = inner_blank || (format_.columns[i] != "-" && !stamp_of(fields_[i]) &&
                                  fields_[i].find_first_of(" \t") != std::string_view::npos);
  }
  return !inner_blank || std::ranges::none_of(fields_, like_a_number);
}

/// Whether a column that is read has letters where values should be.
bool RowReader::has_words() const {
  for (std::size_t i = 0; i < format_.columns.size(); ++i) {
    const std::string low = lower(fields_[i]);
    constexpr std::array kAbsent = {"nan"sv, "inf"sv, "-inf"sv, "null"sv, "na"sv, "n/a"sv};
    const bool letters = std::ranges::any_of(low, [](char c) {
      return (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80;
    });
    if (format_.columns[i] != "-" && letters && !holds_value(fields_[i]) && !is_date(fields_[i]) &&
        !is_time_of_day(fields_[i]) && std::ranges::find(kAbsent, low) == kAbsent.end()) {
      return true;
    }
  }
  return false;
}

void RowReader::take_names(char separator) {
  separator_ = separator;
  for (const std::string& name : format_.columns) {
    head_.name.push_back(name == "-" ? std::string() : name_of(name));
    head_.written.push_back(name == "-" ? std::string() : name);
  }
  have_names_ = true;
  units_may_follow_ = false;
}

/// A line before the first row, if the command line names the columns; the first row itself.
std::optional<Fault> RowReader::take_named(std::string_view text) {
  std::size_t most = 0;
  // In order of how rarely each occurs within a field.
  for (const char candidate : {'\t', ';', ',', ' '}) {
    const bool fits = fits_names(text, candidate);
    most = std::max(most, fields_.size());
    if (!fits) {
      continue;
    }
    if (skipped_ > 0 && are_units(fields_)) {
      take_names(candidate);
      return add_units(fields_, line_, head_);
    }
    if (has_words() || std::ranges::none_of(fields_, holds_value)) {
      break;
    }
    take_names(candidate);
    return behind_head(text);
  }
  return before_rows(text, most);
}

// The header, and the settings that oscilloscopes write above the data.
std::optional<Fault> RowReader::before_rows(std::string_view text, std::size_t most_fields) {
  constexpr std::size_t kMostSkipped = 64;
  Fault fault{line_,
              fmt::format("--columns names {} columns, the row has {}: \"{}\"",
                          format_.columns.size(), most_fields, shown(text)),
              "name each column, with - for one to skip"};
  const char first = trimmed(text).front();
  const bool row = (first >= '0' && first <= '9') || "+-."sv.find(first) != std::string_view::npos;
  if (row || skipped_ == kMostSkipped) {
    return fault;
  }
  if (!first_skipped_ && most_fields != format_.columns.size()) {
    first_skipped_ = std::move(fault);
  }
  if (skipped_++ == 0) {
    notes_.push_back({line_, "the header is skipped", "--columns names the columns"});
  }
  return std::nullopt;
}

void RowReader::take_head_fields() {
  for (const std::string_view field : fields_) {
    head_.name.push_back(name_of(field));
    head_.written.emplace_back(field);
  }
}

/// The line after the head: the units, or the first row. Now the separator can be determined.
std::optional<Fault> RowReader::behind_head(std::string_view text) {
  if (head_.name.empty()) {
    separator_ = separator_of(head_text_, text);
    split_fields(head_text_, separator_, fields_);
    take_head_fields();
  }
  split(text);
  if (units_may_follow_ && fields_.size() <= head_.name.size() && are_units(fields_)) {
    units_may_follow_ = false;
    return add_units(fields_, line_, head_);
  }
  // Some programs end each row with a separator.
  open_end_ = fields_.size() == head_.name.size() + 1 && fields_.back().empty();
  head_.find_times(fields_);
  if (auto fault = give_head()) {
    return fault;
  }
  return take_row(text);
}

// Once, before the first row, so that a missing column is reported before any work is done.
std::optional<Fault> RowReader::give_head() {
  std::optional<Fault> fault;
  if (head_.name.size() > kMostColumns) {
    // A line of garbage can have a million commas.
    fault = Fault{0, fmt::format("{} columns; {} are allowed", head_.name.size(), kMostColumns),
                  "leave out the columns you do not need"};
  } else {
    fault = sink_.head(head_);
  }
  if (fault && fault->line == 0) {
    fault->line = head_.line;
  }
  head_given_ = !fault;
  return fault;
}

void RowReader::split(std::string_view text) {
  split_fields(text, separator_, fields_);
}

// Exactly as many fields as names: a decimal comma in a comma-separated file shows here first.
std::optional<Fault> RowReader::take_row(std::string_view text) {
  split(text);
  if (open_end_ && fields_.size() == head_.name.size() + 1 && fields_.back().empty()) {
    fields_.pop_back();
  }
  if (fields_.size() != head_.name.size()) {
    return Fault{line_,
                 fmt::format("the row has {} fields, the header {}: \"{}\"", fields_.size(),
                             head_.name.size(), shown(trimmed(text))),
                 "give each row one field per column; in a comma-separated file, write decimals "
                 "with a point"};
  }
  return sink_.row(Row(*this, line_, fields_));
}

// A head without a row is still a head: its faults are worth reporting.
std::optional<Fault> RowReader::finish() {
  if (!have_names_ && skipped_ > 0) {
    if (first_skipped_) {
      return first_skipped_;
    }
    take_names(',');
  }
  if (have_names_ && !head_given_) {
    if (head_.name.empty()) {
      separator_ = separator_of(head_text_, "");
      split_fields(head_text_, separator_, fields_);
      take_head_fields();
    }
    if (auto fault = give_head()) {
      return fault;
    }
  }
  return numbers_.unproved();
}

// A text that is wholly in memory; files come through line() block by block.
std::optional<Fault> read_rows(std::string_view text, RowReader& reader) {
  // NUL bytes: UTF-16 without a mark, or no text at all.
  if (text.find('\0') != std::string_view::npos) {
    auto fault = fault_of_kind(text);
    return fault ? fault : Fault{0, "is not text in UTF-8", "save it as CSV in UTF-8 or ASCII"};
  }
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (auto fault = reader.line(text.substr(0, end))) {
      return fault;
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return reader.finish();
}

}  // namespace steadyrest::table
