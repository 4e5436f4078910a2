// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/signal/signal_layout.hpp>
#include <steadyrest/chatter/offline/signal/signal_names.hpp>
#include <steadyrest/table/fields.hpp>
#include <steadyrest/table/stamp.hpp>

namespace steadyrest::chatter::offline {
namespace {

using Fields = std::vector<std::string_view>;

constexpr std::size_t kMostBefore = 200;  // lines

struct TextLine {
  std::size_t number = 0;
  std::string text;  ///< without a comment's mark
  bool comment = false;
};

/// The lines of the front that are not blank.
std::vector<TextLine> front_of(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) {
    text.remove_prefix(kByteOrderMark.size());
  }
  std::vector<TextLine> out;
  for (std::size_t number = 1; !text.empty() && out.size() < kMostBefore; ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    // Tabs at the ends are empty fields; only the CR goes.
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    const std::string_view content = table::trimmed(line);
    if (content.empty() || content == "overrun") {
      continue;
    }
    const bool comment = content.front() == '#' || content.front() == '%';
    if (comment) {
      line = content.substr(std::min(content.find_first_not_of("#% \t"), content.size()));
    }
    out.push_back(
        {number, table::is_utf8(line) ? std::string(line) : table::from_cp1252(line), comment});
  }
  return out;
}

bool holds_time(std::string_view field) {
  return is_number(field) || table::stamp_of(field) || table::is_time_of_day(field);
}

bool all_numbers(const Fields& row) {
  return std::ranges::any_of(row, is_number) &&
         std::ranges::all_of(row, [](auto field) { return is_number(field) || is_gap(field); });
}

/// Rows may end with a separator.
bool as_many(const Fields& head, const Fields& row) {
  return head.size() == row.size() || (head.size() + 1 == row.size() && row.back().empty());
}

class LayoutFinder {
 public:
  LayoutFinder(std::string_view text, const table::Format& format)
      : lines_(front_of(text)), rated_(format.rows_are_samples) {}

  OrFault<SignalLayout> find() {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (auto found = head_at(i)) {
        return std::move(*found);
      }
    }
    const auto first = std::ranges::find(lines_, false, &TextLine::comment);
    return first == lines_.end() ? SignalLayout() : without_head(*first);
  }

 private:
  /// The next line, from this one on, that is not a comment.
  [[nodiscard]] std::size_t row_from(std::size_t at) const {
    while (at < lines_.size() && lines_[at].comment) {
      ++at;
    }
    return at;
  }

  /// Whether it is the head, its fields and the first row's being given.
  [[nodiscard]] bool is_head(const Fields& head, const Fields& row) const {
    if (!as_many(head, row)) {
      return false;
    }
    if (rated_ && all_numbers(row) && std::ranges::none_of(head, table::holds_value)) {
      return true;
    }
    for (std::size_t i = 0; i < head.size() && head.size() > 1; ++i) {
      if (names_a_time(column_name(head[i], head[i])) && holds_time(row[i])) {
        return true;
      }
    }
    return false;
  }

  std::optional<SignalLayout> head_at(std::size_t i) {
    std::size_t j = row_from(i + 1);
    if (j == lines_.size() || (rated_ && lines_[i].comment)) {
      return std::nullopt;
    }
    char separator = table::separator_of(lines_[i].text, lines_[j].text);
    const bool blanks = lines_[i].text.find(separator) == std::string::npos &&
                        lines_[j].text.find_first_of(" \t") != std::string::npos;
    separator = blanks ? ' ' : separator;
    Fields head;
    Fields row;
    table::split_fields(lines_[i].text, separator, head);
    table::split_fields(lines_[j].text, separator, row);
    if (table::are_units(row) && row_from(j + 1) < lines_.size() && !blanks) {
      j = row_from(j + 1);
      table::split_fields(lines_[j].text, separator, row);
    }
    if (!is_head(head, row)) {
      return std::nullopt;
    }
    SignalLayout out;
    out.head_line = lines_[i].number;
    out.head = lines_[i].text;
    if (blanks) {
      out.columns.assign(head.begin(), head.end());
    }
    if (const auto before =
            std::ranges::count(lines_.begin(), lines_.begin() + at(i), false, &TextLine::comment);
        before > 0) {
      out.notes.push_back(fmt::format("the header is line {}: {} {} before it skipped",
                                      out.head_line, before, before == 1 ? "line" : "lines"));
    }
    return out;
  }

  OrFault<SignalLayout> without_head(const TextLine& first) const {
    Fields row;
    for (const char separator : {'\t', ';', ',', ' '}) {
      table::split_fields(first.text, separator, row);
      if (row.size() > 1 && rows_of(row)) {
        break;
      }
    }
    // A single column with decimal commas looks like two columns of whole numbers; the first is
    // not a time.
    if (!rows_of(row)) {
      return SignalLayout();
    }
    SignalLayout out;
    if (rated_) {
      for (std::size_t i = 0; i < row.size(); ++i) {
        out.columns.push_back(row.size() == 1 ? "value" : fmt::format("column {}", i + 1));
      }
      out.notes.emplace_back("there is no header: every column is a channel");
      return out;
    }
    if (row.size() == 2) {
      out.columns = {"t_s", "value"};
      out.time = "the first column, without a header the time,";
      out.notes.emplace_back(
          "there is no header: the first column is the time in s, the second the signal");
      return out;
    }
    return std::unexpected(SignalFault{
        first.number,
        fmt::format("there is no header before \"{}\"; without one two columns are time and value, "
                    "this has {}",
                    table::shown(table::trimmed(first.text)), row.size()),
        row.size() == 1 ? "give the samples per second with --rate-hz"
                        : "name the columns in a first line or with --columns; without a column of "
                          "times give --rate-hz"});
  }

  static bool rows_of(const Fields& row) {
    return all_numbers(row) || (row.size() == 2 && holds_time(row[0]) && is_number(row[1]));
  }

  static std::ptrdiff_t at(std::size_t i) { return static_cast<std::ptrdiff_t>(i); }

  std::vector<TextLine> lines_;
  bool rated_;
};

}  // namespace

OrFault<SignalLayout> layout_of(std::string_view text, const table::Format& format) {
  if (!format.columns.empty() || table::fault_of_kind(text)) {
    return SignalLayout();
  }
  return LayoutFinder(text, format).find();
}

bool is_gap(std::string_view field) {
  if (field.empty()) {
    return true;
  }
  const std::size_t sign = field.front() == '-' || field.front() == '+' ? 1 : 0;
  const std::string_view rest = field.substr(sign);
  const bool plain = !rest.empty() && rest.find('#') == std::string_view::npos &&
                     ((rest.front() >= '0' && rest.front() <= '9') || rest.front() == '.');
  if (plain) {
    return false;
  }
  constexpr std::array<std::string_view, 20> kWords = {
      "",        "nan",    "nan(ind)", "nan(snan)", "inf",   "infinity", "null",
      "none",    "na",     "n/a",      "#n/a",      "#nv",   "-",        "nil",
      "1.#qnan", "1.#inf", "1.#ind",   "1.#nan",    "#num!", "#div/0!"};
  return std::ranges::find(kWords, table::lower(rest)) != kWords.end();
}

bool is_number(std::string_view field) {
  if (table::plain_number(field)) {
    return !is_gap(field);
  }
  std::string text(field);
  return std::ranges::count(text, ',') == 1 && text.find('.') == std::string::npos &&
         (std::ranges::replace(text, ',', '.'), table::plain_number(text).has_value());
}

}  // namespace steadyrest::chatter::offline
