// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <span>

#include <fmt/core.h>

#include <steadyrest/table/head.hpp>
#include <steadyrest/table/number.hpp>
#include <steadyrest/table/stamp.hpp>

// Column names end in their unit, as everywhere in this project. Heads write units in brackets, in
// a row below the names or in the name; all are converted to the same form.
namespace steadyrest::table {
namespace {

using namespace std::string_view_literals;

/// Units by the endings of names.
constexpr std::array kUnits = {
    "s"sv,     "ms"sv,     "us"sv,   "ns"sv,     "min"sv,     "h"sv,    "hz"sv,    "khz"sv,
    "m"sv,     "mm"sv,     "um"sv,   "nm"sv,     "in"sv,      "c"sv,    "k"sv,     "f"sv,
    "rpm"sv,   "n"sv,      "kn"sv,   "g"sv,      "deg"sv,     "rad"sv,  "w"sv,     "kw"sv,
    "v"sv,     "mv"sv,     "a"sv,    "db"sv,     "m/n"sv,     "mm/n"sv, "um/n"sv,  "nm/n"sv,
    "m/s/n"sv, "mm/s/n"sv, "g/n"sv,  "m/s2/n"sv, "mm/s2/n"sv, "m/s2"sv, "mm/s2"sv, "mm/s"sv,
    "m/s"sv,   "mm/min"sv, "n/um"sv, "nm/v"sv,   "v/n"sv,
};
/// Other words for one of them; "1" is none at all.
struct Other {
  std::string_view word;
  std::string_view unit;
};
constexpr std::array kOthers = {
    Other{"sec", "s"},     Other{"degc", "c"},    Other{"degf", "f"},    Other{"celsius", "c"},
    Other{"1/min", "rpm"}, Other{"u/min", "rpm"}, Other{"min-1", "rpm"}, Other{"rev/min", "rpm"},
    Other{"-", "1"},       Other{"1", "1"},       Other{"%", "1"},       Other{"count", "1"},
    Other{"counts", "1"},  Other{"inc", "1"},     Other{"micron", "um"}, Other{"microns", "um"},
    Other{"iso8601", "1"}, Other{"inch", "in"},
};

/// Lower case; µ (either code) as u, `^2` and `²` as 2; without blanks, ° and round brackets.
std::string plain(std::string_view field) {
  std::string out;
  for (std::size_t i = 0; i < field.size(); ++i) {
    const std::string_view rest = field.substr(i);
    if (rest.starts_with("\xC2\xB5") || rest.starts_with("\xCE\xBC")) {
      out += 'u';
      ++i;
    } else if (rest.starts_with("\xC2\xB2")) {
      out += '2';
      ++i;
    } else if (rest.starts_with("\xC2\xB0")) {
      ++i;
    } else if (std::string_view(" ^()").find(field[i]) == std::string_view::npos) {
      out += field[i];
    }
  }
  return lower(out);
}

// Some programs quote heads although nothing in them needs it.
std::string_view unquoted(std::string_view field) {
  field = trimmed(field);
  const bool quoted = field.size() >= 2 && field.front() == '"' && field.back() == '"';
  return quoted ? trimmed(field.substr(1, field.size() - 2)) : field;
}

bool bracketed(std::string_view field) {
  return field.size() > 2 && ((field.front() == '[' && field.back() == ']') ||
                              (field.front() == '(' && field.back() == ')'));
}

/// Every bracket that opens in it closes in it: `((m/s²)/N)`, but not `(m/s²)/N)`.
bool balanced(std::string_view text, char open, char close) {
  return std::ranges::count(text, open) == std::ranges::count(text, close);
}

struct TimeUnit {
  std::string_view name;
  double s;
};
constexpr std::array kTimeUnits = {TimeUnit{"s", 1.0},    TimeUnit{"ms", 1e-3},
                                   TimeUnit{"us", 1e-6},  TimeUnit{"ns", 1e-9},
                                   TimeUnit{"min", 60.0}, TimeUnit{"h", 3600.0}};

bool names_time(std::string_view word) {
  constexpr std::array kWords = {"t"sv, "time"sv, "timestamp"sv, "epoch"sv, "unixtime"sv};
  return std::ranges::find(kWords, word) != kWords.end();
}

/// Seconds per unit of a number that is a time since 1970, between 2001 and 2096; 0: it is none.
double since_1970(std::string_view name, std::string_view field) {
  constexpr double kEarliest_s = 1e9;
  constexpr double kLatest_s = 4e9;
  const auto value = plain_number(field);
  if (!value) {
    return 0.0;
  }
  const bool bare = names_time(lower(name));
  const auto named = time_factor(name);
  for (const TimeUnit& unit : kTimeUnits) {
    const bool allowed = bare ? unit.s <= 1.0 : named && *named == unit.s && unit.s < 1.0;
    if (allowed && *value * unit.s >= kEarliest_s && *value * unit.s <= kLatest_s) {
      return unit.s;
    }
  }
  return 0.0;
}

}  // namespace

std::optional<double> time_factor(std::string_view name) {
  const std::string low = lower(name);
  const std::size_t mark = low.rfind('_');
  if (mark == std::string::npos || !names_time(std::string_view(low).substr(0, mark))) {
    return std::nullopt;
  }
  const auto* const unit =
      std::ranges::find(kTimeUnits, std::string_view(low).substr(mark + 1), &TimeUnit::name);
  return unit == kTimeUnits.end() ? std::nullopt : std::optional(unit->s);
}

std::optional<std::size_t> Head::place(std::string_view wanted) const {
  const auto at = std::ranges::find(name, wanted);
  return at == name.end() ? std::nullopt
                          : std::optional(static_cast<std::size_t>(at - name.begin()));
}

// Two columns with the same name: nobody can tell which is meant. Columns without a name do not
// count.
std::optional<Fault> Head::twice(std::string_view only) const {
  for (std::size_t i = 1; i < name.size(); ++i) {
    const auto before = std::span(name).first(i);
    const bool counts = only.empty() ? !name[i].empty() : name[i] == only;
    if (counts && std::ranges::find(before, name[i]) != before.end()) {
      return Fault{line, fmt::format("the column {} appears twice", shown(name[i])),
                   "give each column a different name"};
    }
  }
  return std::nullopt;
}

void Head::find_times(const std::vector<std::string_view>& row) {
  const auto only = [&](const auto& is) {
    std::optional<std::size_t> out;
    for (std::size_t i = 0; i < std::min(row.size(), name.size()); ++i) {
      if (is(i)) {
        // Two of them: indistinguishable.
        out = out ? name.size() : i;
      }
    }
    return out == name.size() ? std::nullopt : out;
  };
  const auto is_stamp = [&](std::size_t i) { return stamp_of(row[i]).has_value(); };
  stamped = only(is_stamp);
  const bool none =
      std::ranges::none_of(row, [](std::string_view f) { return stamp_of(f).has_value(); });
  const auto date = only([&](std::size_t i) { return is_date(row[i]); });
  const auto time = only([&](std::size_t i) { return is_time_of_day(row[i]); });
  if (none && date && time) {
    stamped = date;
    clocked = time;
  }
  epoch = only([&](std::size_t i) { return since_1970(name[i], row[i]) > 0.0; });
  epoch_factor = epoch ? since_1970(name[*epoch], row[*epoch]) : 1.0;
}

// A word that is no unit is part of the name: `load (left)` stays as it is.
std::string unit_of(std::string_view field) {
  field = unquoted(field);
  if (bracketed(field)) {
    field = trimmed(field.substr(1, field.size() - 2));
  }
  std::string word = plain(field);
  if (std::ranges::find(kUnits, word) != kUnits.end()) {
    return word;
  }
  const auto* const other = std::ranges::find(kOthers, word, &Other::word);
  return other == kOthers.end() ? std::string() : std::string(other->unit);
}

// `z [µm]` becomes `z_um`: the form in which the program looks up its columns.
std::string name_of(std::string_view field) {
  field = unquoted(field);
  const char close = field.empty() ? '\0' : field.back();
  if (close != ']' && close != ')') {
    return std::string(field);
  }
  // The unit may contain brackets: `real ((m/s²)/N)`.
  const char open = close == ']' ? '[' : '(';
  for (std::size_t at = field.rfind(open); at != std::string_view::npos && at > 0;
       at = field.rfind(open, at - 1)) {
    const std::string name(trimmed(field.substr(0, at)));
    const std::string_view last = field.substr(at);
    const std::string unit = balanced(last, open, close) ? unit_of(last) : std::string();
    if (!unit.empty()) {
      return unit == "1" ? name : name + "_" + unit;
    }
  }
  return std::string(field);
}

// A second line of units only, with at least one that is definitely a unit.
bool are_units(const std::vector<std::string_view>& fields) {
  bool any = false;
  for (const std::string_view field : fields) {
    const bool empty = unquoted(field).empty();
    if (!empty && unit_of(field).empty()) {
      return false;
    }
    // A row of blanks and ones could just as well be a row of numbers.
    any = any || (!empty && unit_of(field) != "1");
  }
  return any;
}

std::optional<Fault> add_units(const std::vector<std::string_view>& fields, std::size_t line,
                               Head& head) {
  for (std::size_t i = 0; i < std::min(fields.size(), head.name.size()); ++i) {
    std::string& name = head.name[i];
    const std::string unit = unit_of(fields[i]);
    const std::size_t mark = name.rfind('_');
    const std::string own = mark == std::string::npos ? "" : unit_of(name.substr(mark + 1));
    if (unit.empty() || unit == "1" || name.empty() || lower(name).ends_with("_" + unit)) {
      continue;
    }
    // Two units for one column: nobody can tell which is right.
    if (!own.empty()) {
      return Fault{line, fmt::format("the unit of {} is \"{}\"", shown(name), shown(fields[i])),
                   "make the unit in the name agree with the row of units"};
    }
    name += "_" + unit;
  }
  return std::nullopt;
}

}  // namespace steadyrest::table
