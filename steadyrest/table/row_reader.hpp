// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/table/head.hpp>
#include <steadyrest/table/number.hpp>
#include <steadyrest/table/text.hpp>

/// The one reader of columns: the output of loggers, samplers and spreadsheets, line by line.
///
/// Accepted: separator `,`, `;` or tab (the first in the head that splits head and first row
/// alike); quoted fields; a decimal point, or a comma for the whole file (number.hpp); LF or CR LF;
/// a byte order mark; lines in Windows' code page 1252 (noted); blank lines; lines that begin with
/// `#`; units in the names, `z [µm]`, or in a separate row after the head; a separator after the
/// last field of every row. Without a head (Format::columns) blanks may separate the fields too, as
/// halsampler(1) prints them; its line `overrun` is skipped and noted, and so are up to 64 lines of
/// words before the first row.
namespace steadyrest::table {

/// What the file itself does not tell.
struct Format {
  /// Names of the columns, `-` for a column to ignore; empty: the first line has them. A head in
  /// the file is then skipped.
  std::vector<std::string> columns;
  Decimal decimal = Decimal::by_file;
  double sample_hz = 0.0;         ///< rate of a column `sample`; 0: not known
  bool rows_are_samples = false;  ///< without a time the rows are `sample_hz` apart
};

class RowReader;

/// One row, valid while the sink is called.
class Row {
 public:
  Row(RowReader& reader, std::size_t line, const std::vector<std::string_view>& fields) noexcept
      : reader_(reader), line_(line), fields_(fields) {}

  [[nodiscard]] std::size_t line() const noexcept { return line_; }
  [[nodiscard]] std::size_t size() const noexcept { return fields_.size(); }
  [[nodiscard]] std::string_view field(std::size_t column) const { return fields_[column]; }
  /// A finite number.
  [[nodiscard]] std::expected<double, Fault> number(std::size_t column) const;

 private:
  RowReader& reader_;
  std::size_t line_;
  const std::vector<std::string_view>& fields_;
};

/// Receives the head, once, before the first row; a fault that it returns ends the reading.
class Sink {
 public:
  Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;
  virtual ~Sink() = default;
  virtual std::optional<Fault> head(const Head& head) = 0;
  /// Has as many fields as the head.
  virtual std::optional<Fault> row(const Row& row) = 0;
};

class RowReader {
 public:
  RowReader(Format format, Sink& sink);

  /// The next line, without its LF. Returns the fault that ends the reading.
  [[nodiscard]] std::optional<Fault> line(std::string_view text);
  /// No more lines. Returns the fault of the file as a whole.
  [[nodiscard]] std::optional<Fault> finish();

  [[nodiscard]] const Format& format() const noexcept { return format_; }
  [[nodiscard]] std::size_t line_number() const noexcept { return line_; }
  /// Whether the sink has received its head.
  [[nodiscard]] bool has_head() const noexcept { return head_given_; }
  /// What was skipped, at most 20 entries.
  [[nodiscard]] const std::vector<Fault>& notes() const noexcept { return notes_; }
  [[nodiscard]] NumberReader& numbers() noexcept { return numbers_; }
  [[nodiscard]] const Head& names() const noexcept { return head_; }

 private:
  std::optional<Fault> first_line(std::string_view& text);
  std::optional<Fault> take_head(std::string_view text);
  std::optional<Fault> take_named(std::string_view text);
  std::optional<Fault> before_rows(std::string_view text, std::size_t most_fields);
  [[nodiscard]] bool fits_names(std::string_view text, char separator);
  [[nodiscard]] bool has_words() const;
  void take_names(char separator);
  void take_head_fields();
  std::optional<Fault> behind_head(std::string_view text);
  std::optional<Fault> give_head();
  std::optional<Fault> take_row(std::string_view text);
  std::optional<Fault> overrun();
  void split(std::string_view text);

  Format format_;
  Sink& sink_;
  NumberReader numbers_;
  Head head_;
  std::string head_text_;
  std::string converted_;  ///< the line, where it is not UTF-8
  bool conversion_noted_ = false;
  std::size_t skipped_ = 0;  ///< lines before the first row of named columns
  std::optional<Fault> first_skipped_;
  std::size_t line_ = 0;
  char separator_ = ',';  ///< ' ' = any number of blanks and tabs
  bool have_names_ = false;
  bool units_may_follow_ = true;
  bool head_given_ = false;
  bool open_end_ = false;  ///< every row ends with a separator
  std::vector<std::string_view> fields_;
  std::vector<Fault> notes_;
};

/// All lines of a text. `to_do` says what to give if it is no text at all.
[[nodiscard]] std::optional<Fault> read_rows(std::string_view text, RowReader& reader);

}  // namespace steadyrest::table
