// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include <steadyrest/chatter/offline/signal/signal_names.hpp>
#include <steadyrest/table/head.hpp>
#include <steadyrest/table/text.hpp>

// A name is taken for a time or a speed by whole words alone: `timer` and `feed speed` are sensors.
namespace steadyrest::chatter::offline {
namespace {

using namespace std::string_view_literals;

struct TimeSpelling {
  std::string_view word;
  std::string_view unit;
};
constexpr std::array kTimeSpellings = {
    TimeSpelling{"s", "s"},         TimeSpelling{"sec", "s"},           TimeSpelling{"secs", "s"},
    TimeSpelling{"second", "s"},    TimeSpelling{"seconds", "s"},       TimeSpelling{"ms", "ms"},
    TimeSpelling{"msec", "ms"},     TimeSpelling{"millisecond", "ms"},  TimeSpelling{"us", "us"},
    TimeSpelling{"usec", "us"},     TimeSpelling{"milliseconds", "ms"}, TimeSpelling{"ns", "ns"},
    TimeSpelling{"nsec", "ns"},     TimeSpelling{"microsecond", "us"},  TimeSpelling{"min", "min"},
    TimeSpelling{"minutes", "min"}, TimeSpelling{"microseconds", "us"}, TimeSpelling{"h", "h"},
    TimeSpelling{"hours", "h"},     TimeSpelling{"nanoseconds", "ns"}};

// LabVIEW calls the times of its text files X_Value.
constexpr std::array kTimeWords = {
    "t"sv,         "time"sv,         "times"sv,    "timestamp"sv,     "time stamp"sv, "epoch"sv,
    "unixtime"sv,  "elapsed time"sv, "elapsed"sv,  "time elapsed"sv,  "zeit"sv,       "x value"sv,
    "rel time"sv,  "time rel"sv,     "duration"sv, "relative time"sv, "runtime"sv,    "test time"sv,
    "zeitachse"sv, "time axis"sv};

constexpr std::array kPerMinute = {"rpm"sv,     "1/min"sv,    "min-1"sv, "u/min"sv, "rev/min"sv,
                                   "r/min"sv,   "revs/min"sv, "/min"sv,  "t/min"sv, "tr/min"sv,
                                   "rev min"sv, "min^-1"sv,   "upm"sv};
constexpr std::array kPerSecond = {"rev/s"sv, "r/s"sv, "1/s"sv,   "s-1"sv,    "s^-1"sv, "rps"sv,
                                   "hz"sv,    "u/s"sv, "rev s"sv, "revs/s"sv, "/s"sv};

constexpr std::array kSpeedWords = {"speed"sv,
                                    "spindle speed"sv,
                                    "spindlespeed"sv,
                                    "rotational speed"sv,
                                    "rotation speed"sv,
                                    "rotary speed"sv,
                                    "drehzahl"sv,
                                    "spindeldrehzahl"sv,
                                    "shaft speed"sv,
                                    "spindle drehzahl"sv,
                                    "actual spindle speed"sv,
                                    "spindle speed actual"sv,
                                    "actual speed"sv,
                                    "n actual"sv,
                                    "speed actual"sv,
                                    "spindle actual speed"sv,
                                    "spindle rotation"sv};
/// A speed only beside its unit.
constexpr std::array kShortSpeedWords = {"n"sv,     "spindle"sv, "rev"sv,        "revs"sv,
                                         "tacho"sv, "tach"sv,    "tachometer"sv, "s1"sv,
                                         "f rot"sv, "rotation"sv};

constexpr std::array kRowWords = {
    "sample"sv, "samples"sv, "sample no"sv, "index"sv,        "no"sv,
    "nr"sv,     "row"sv,     "#"sv,         "record"sv,       "sample number"sv,
    "point"sv,  "line"sv,    "sample nr"sv, "sample index"sv, "id"sv};

template <class List>
bool among(const List& list, std::string_view word) {
  return std::ranges::find(list, word) != list.end();
}

/// Lower case, with one blank for any of ` _.-:`: `Spindle_Speed` as `spindle speed`.
std::string plain_words(std::string_view name) {
  std::string out;
  for (const char c : table::lower(name)) {
    const bool blank = " \t_.-:"sv.find(c) != std::string_view::npos;
    if (!blank) {
      out += c;
    } else if (!out.empty() && out.back() != ' ') {
      out += ' ';
    }
  }
  return out.ends_with(' ') ? out.substr(0, out.size() - 1) : out;
}

/// Lower case without blanks, µ as u, ⁻¹ as -1, · left out.
std::string plain_unit(std::string_view unit) {
  std::string out = table::lower(table::trimmed(unit));
  constexpr std::array kSigns = {std::pair{"\xC2\xB5"sv, "u"sv}, std::pair{"\xCE\xBC"sv, "u"sv},
                                 std::pair{"\xE2\x81\xBB\xC2\xB9"sv, "-1"sv},
                                 std::pair{" "sv, ""sv}, std::pair{"\xC2\xB7"sv, ""sv}};
  for (const auto& [from, to] : kSigns) {
    for (std::size_t at = out.find(from); at != std::string::npos; at = out.find(from, at)) {
      out.replace(at, from.size(), to);
    }
  }
  return out;
}

/// The words before the last `count` of them, and those.
std::pair<std::string_view, std::string_view> ending(std::string_view words, int count) {
  std::size_t at = words.size();
  for (int i = 0; i < count && at != std::string_view::npos && at > 0; ++i) {
    at = words.rfind(' ', at - 1);
  }
  return at == std::string_view::npos || at == 0
             ? std::pair{std::string_view(), words}
             : std::pair{words.substr(0, at), words.substr(at + 1)};
}

std::optional<double> rev_s_per(std::string_view unit) {
  constexpr double kMinute_s = 60.0;
  return among(kPerMinute, unit)   ? std::optional(1.0 / kMinute_s)
         : among(kPerSecond, unit) ? std::optional(1.0)
                                   : std::nullopt;
}

/// A speed in that unit: in rev/min whatever its name, since nothing else turns so.
std::optional<SpeedName> speed_in(std::string_view name, std::string_view unit) {
  const auto per = rev_s_per(unit);
  const bool named = among(kSpeedWords, name) || among(kShortSpeedWords, name);
  return per && (named || *per < 1.0) ? std::optional(SpeedName{*per, true}) : std::nullopt;
}

}  // namespace

ColumnName column_name(std::string_view written, std::string_view in_head) {
  ColumnName out{std::string(written), std::string(written), {}};
  const char close = written.empty() ? '\0' : written.back();
  if (close == ')' || close == ']') {
    const char open = close == ')' ? '(' : '[';
    int depth = 0;
    std::size_t at = written.size();
    while (at > 0) {
      --at;
      depth += written[at] == close ? 1 : written[at] == open ? -1 : 0;
      if (depth == 0) {
        break;
      }
    }
    if (depth == 0 && at > 0) {
      out.name = std::string(table::trimmed(written.substr(0, at)));
      out.unit = std::string(table::trimmed(written.substr(at + 1, written.size() - at - 2)));
    }
  } else if (in_head.size() > written.size() && in_head.starts_with(written) &&
             in_head[written.size()] == '_') {
    out.unit = std::string(in_head.substr(written.size() + 1));
  }
  return out;
}

std::string shown_name(std::string_view name) {
  constexpr std::size_t kMostShown = 60;
  std::string out = table::is_utf8(name) ? std::string(name) : table::from_cp1252(name);
  if (out.size() > kMostShown) {
    std::size_t end = kMostShown;
    while (end > 0 && (static_cast<unsigned char>(out[end]) & 0xC0U) == 0x80U) {  // inside a sign
      --end;
    }
    out = out.substr(0, end) + "…";
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto byte = static_cast<unsigned char>(out[i]);
    const bool high_control =
        byte == 0xC2 && i + 1 < out.size() && static_cast<unsigned char>(out[i + 1]) < 0xA0;
    if (byte < 0x20 || byte == 0x7F) {
      out[i] = '?';
    } else if (high_control) {
      out.replace(i, 2, "?");
    }
  }
  return out;
}

std::string without_unit(std::string_view name) {
  const std::size_t mark = name.find_last_of("_ ");
  if (mark == std::string_view::npos || mark == 0) {
    return std::string(name);
  }
  const std::string unit = table::unit_of(name.substr(mark + 1));
  return std::string(unit.empty() || unit == "1" ? name : name.substr(0, mark));
}

std::optional<std::string_view> time_unit(std::string_view unit) {
  const auto* const found =
      std::ranges::find(kTimeSpellings, plain_unit(unit), &TimeSpelling::word);
  return found == kTimeSpellings.end() ? std::nullopt : std::optional(found->unit);
}

std::optional<TimeName> names_a_time(const ColumnName& column) {
  const std::string words = plain_words(column.name);
  if (!column.unit.empty()) {
    const auto unit = time_unit(column.unit);
    return unit && among(kTimeWords, words) ? std::optional(TimeName{*unit, true}) : std::nullopt;
  }
  // LabVIEW counts in seconds.
  if (among(kTimeWords, words)) {
    return TimeName{"s", words == "x value"};
  }
  // A letter alone may be anything: `s` a path, `h` a height.
  if (const auto unit = time_unit(words); unit && words.size() > 2) {
    return TimeName{*unit, true};
  }
  const auto [name, last] = ending(words, 1);
  const auto unit = time_unit(last);
  return unit && among(kTimeWords, name) ? std::optional(TimeName{*unit, true}) : std::nullopt;
}

std::optional<SpeedName> names_a_speed(const ColumnName& column) {
  const std::string words = plain_words(column.name);
  if (!column.unit.empty()) {
    return speed_in(words, plain_unit(column.unit));
  }
  if (among(kSpeedWords, words)) {
    return SpeedName{*rev_s_per("rpm"), false};
  }
  for (const int count : {1, 2}) {
    const auto [name, last] = ending(words, count);
    if (last == "rpm" && count == 1) {
      return SpeedName{*rev_s_per("rpm"), true};
    }
    if (auto speed = speed_in(name, last); speed && !name.empty()) {
      return speed;
    }
  }
  return std::nullopt;
}

bool same_name(std::string_view a, std::string_view b) {
  const auto plain = [](std::string_view name) {
    std::string out = table::lower(table::trimmed(name));
    std::ranges::replace(out, '_', ' ');
    return out;
  };
  return plain(a) == plain(b);
}

bool is_slow_quantity(const ColumnName& column) {
  constexpr std::array<std::string_view, 9> kUnits = {"c",  "°c",  "degc", "k", "f",
                                                      "°f", "bar", "kpa",  "%"};
  constexpr std::array<std::string_view, 8> kWords = {"temp",         "temperature", "temperatur",
                                                      "coolant temp", "load",        "spindle load",
                                                      "last",         "humidity"};
  return among(kUnits, plain_words(column.unit)) || among(kWords, plain_words(column.name));
}

bool numbers_rows(const ColumnName& column) {
  return column.unit.empty() && among(kRowWords, plain_words(column.name));
}

}  // namespace steadyrest::chatter::offline
