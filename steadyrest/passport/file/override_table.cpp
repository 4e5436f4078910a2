// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <set>

#include <steadyrest/kernel/override/gray.hpp>
#include <steadyrest/kernel/override/table.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/passport/file/override_table.hpp>

// An override table is machine data and never a constant: the code that means 100 % elsewhere means
// 70 % on one 840D sl. A table is therefore checked for every likely typing error: order, duplicate
// codes, neighbours that differ in two bits.
namespace steadyrest::passport {
namespace {

using kernel::machine::Coding;
using kernel::machine::OverrideTable;

/// 1000 % in steps of 0.5 %.
constexpr std::size_t kMaxSteps = 2001;

/// Binary mode: the word is the number of the step, from 0 (SINUMERIK's binary mode, LinuxCNC).
bool even_steps(const OverrideKeys& keys, const Given& given, Faults& faults, OverrideTable& out) {
  if (keys.coding != Coding::binary) {
    faults.add(given.at({"binary_max_percent"}),
               fmt::format("{} has binary_max_percent, but its coding is gray", given.section),
               "write coding = \"binary\", or give the steps as percent = [ … ]");
    return false;
  }
  // The steps must end exactly at the largest value, or the last code would mean more than it
  // claims.
  const double ratio = keys.binary_max / keys.binary_step;
  const double whole = std::round(ratio);
  if (std::abs(ratio - whole) > 1e-6 || whole < 1 || whole + 1 > static_cast<double>(kMaxSteps)) {
    faults.add(
        given.at({"binary_step_percent", "binary_max_percent"}),
        fmt::format(
            "{} has {} steps from 0 to its largest value; allowed: a whole number from 1 to {}",
            given.section, shown(ratio), kMaxSteps - 1),
        "choose a binary_step_percent that divides binary_max_percent");
    return false;
  }
  const auto steps = static_cast<std::size_t>(whole);
  for (std::size_t i = 0; i <= steps; ++i) {
    out.ratio.push_back(keys.binary_max * static_cast<double>(i) / whole);
    out.code.push_back(static_cast<std::uint32_t>(i));
  }
  return true;
}

/// The switch is a staircase: a step that falls is a swapped entry, and the search for the next
/// lower step depends on the order. Equal steps are allowed (unused positions repeat the last
/// value).
bool rising(const OverrideKeys& keys, const Given& given, Faults& faults) {
  for (std::size_t i = 1; i < keys.percent.size(); ++i) {
    if (keys.percent[i] < keys.percent[i - 1]) {
      faults.add(given.at({"percent"}),
                 fmt::format("{} percent falls from {} to {} at entry {}", given.section,
                             shown(kernel::units::percent_from_ratio(keys.percent[i - 1])),
                             shown(kernel::units::percent_from_ratio(keys.percent[i])), i + 1),
                 "list the steps in rising order, and codes = [ … ] in the same order");
      return false;
    }
  }
  return true;
}

/// Without codes: SINUMERIK's rule, index i has the Gray code of i + 1, so 00000 is never a valid
/// position; or, binary, the percent itself.
bool default_codes(const OverrideKeys& keys, const Given& given, Faults& faults,
                   OverrideTable& out) {
  for (std::size_t i = 0; i < keys.percent.size(); ++i) {
    const double percent = kernel::units::percent_from_ratio(keys.percent[i]);
    if (keys.coding == Coding::gray) {
      out.code.push_back(kernel::override::sinumerik_code(i));
    } else if (std::abs(percent - std::round(percent)) < 1e-9) {
      out.code.push_back(static_cast<std::uint32_t>(std::lround(percent)));
    } else {
      faults.add(given.at({"percent"}),
                 fmt::format("{} percent has {}, but a binary word is a whole percent",
                             given.section, shown(percent)),
                 "add codes = [ … ], or use binary_max_percent with binary_step_percent");
      return false;
    }
  }
  return true;
}

/// One code with two meanings makes the panel unreadable.
bool distinct(const Given& given, Faults& faults, const OverrideTable& out) {
  std::set<std::uint32_t> seen;
  for (const std::uint32_t code : out.code) {
    if (!seen.insert(code).second) {
      faults.add(given.at({"codes", "percent"}),
                 fmt::format("{} has the code {} twice", given.section, code),
                 "give each step a different code");
      return false;
    }
  }
  return true;
}

/// Neighbours of a Gray switch differ in one bit, so a word read between two positions is one of
/// them. A pair that differs in more is a typing error.
bool gray_neighbours(const Given& given, Faults& faults, const OverrideTable& out) {
  for (std::size_t i = 1; out.coding == Coding::gray && i < out.code.size(); ++i) {
    const std::uint32_t before = out.code[i - 1];
    const std::uint32_t here = out.code[i];
    if (std::popcount(before ^ here) != 1) {
      faults.add(
          given.at({"codes"}),
          fmt::format(
              "{} has adjacent Gray codes {} = {:05b} and {} = {:05b} that differ in {} bits",
              given.section, before, before, here, here, std::popcount(before ^ here)),
          "correct the codes (neighbours differ in one bit), or write coding = \"binary\"");
      return false;
    }
  }
  return true;
}

/// The steps of a switch, position by position.
bool listed_steps(const OverrideKeys& keys, const Given& given, Faults& faults,
                  OverrideTable& out) {
  if (given.has("binary_step_percent")) {
    faults.add(given.at({"binary_step_percent"}),
               fmt::format("{} has binary_step_percent without binary_max_percent", given.section),
               "remove it, or give binary_max_percent instead of percent");
    return false;
  }
  if (keys.percent.size() > kMaxSteps) {
    faults.add(given.at({"percent"}),
               fmt::format("{} has {} steps; the most is {}", given.section, keys.percent.size(),
                           kMaxSteps),
               "leave out some steps");
    return false;
  }
  if (!rising(keys, given, faults)) {
    return false;
  }
  if (given.has("codes")) {
    if (keys.codes.size() != keys.percent.size()) {
      faults.add(given.at({"codes"}),
                 fmt::format("{} has {} codes for {} steps", given.section, keys.codes.size(),
                             keys.percent.size()),
                 "give one code per entry of percent");
      return false;
    }
    out.code = keys.codes;
  } else if (!default_codes(keys, given, faults, out)) {
    return false;
  }
  out.ratio = keys.percent;
  return distinct(given, faults, out) && gray_neighbours(given, faults, out);
}

/// Either even steps or a list; both would be two tables.
bool make_override(const OverrideKeys& keys, const Given& given, Faults& faults,
                   OverrideTable& out) {
  const bool even = given.has("binary_max_percent");
  if (even == given.has("percent")) {
    faults.add(even ? given.at({"binary_max_percent"}) : given.line,
               fmt::format("{} has {} percent {} binary_max_percent", given.section,
                           even ? "both" : "neither", even ? "and" : "nor"),
               "give one of them: the list of steps, or the largest value of even steps");
    return false;
  }
  if (even && given.has("codes")) {
    faults.add(given.at({"codes"}), fmt::format("{} has codes but no percent", given.section),
               "remove codes: with binary_max_percent the word is the step number");
    return false;
  }
  OverrideTable table;
  table.coding = keys.coding;
  table.scan_period_s = keys.scan_period_s;
  table.dead_time_s = keys.dead_time_s;
  table.latched_word = keys.latched_word;
  table.layer_may_exceed_panel = keys.layer_may_exceed_panel;
  table.max_ratio = keys.max_ratio;
  if (!(even ? even_steps(keys, given, faults, table) : listed_steps(keys, given, faults, table))) {
    return false;
  }
  // A table of zeros would stop the machine for good.
  if (table.ratio.back() <= 0.0) {
    faults.add(given.at({"percent"}), fmt::format("{} has no step above 0 %", given.section),
               "list the steps of the switch");
    return false;
  }
  // The envelope builds its table from this value later; what it would refuse is refused here, with
  // its line.
  if (const auto made = kernel::override::Table::make(table); !made) {
    faults.add(given.line, fmt::format("{}: {}", given.section, made.error().what),
               made.error().to_do);
    return false;
  }
  out = std::move(table);
  return true;
}

/// Without its own table the rapid override follows the feed switch up to 100 %: no control
/// runs rapids faster than their setting.
OverrideTable rapid_from_feed(const OverrideTable& feed) {
  OverrideTable rapid = feed;
  for (double& ratio : rapid.ratio) {
    ratio = std::min(ratio, 1.0);
  }
  rapid.max_ratio = std::min(feed.max_ratio, 1.0);
  return rapid;
}

/// No switch: the spindle has only 100 %, so every request ends there.
OverrideTable without_override() {
  OverrideTable table;
  table.coding = Coding::binary;
  table.ratio = {1.0};
  table.code = {100};
  table.max_ratio = 1.0;
  return table;
}

bool override_at(const toml::table& parent, std::string_view name, Faults& faults,
                 OverrideTable& out) {
  const std::string head = fmt::format("[override.{}]", name);
  const toml::table* table = table_below(faults, parent, name, head);
  if (table == nullptr) {
    return false;
  }
  OverrideKeys keys;
  const std::size_t before = faults.list.size();
  SectionReader<OverrideKeys> reader(faults, override_keys(), head);
  const Given given = reader.read(*table, keys);
  return faults.list.size() == before && make_override(keys, given, faults, out);
}

}  // namespace

void read_overrides(const toml::table& root, kernel::machine::Machine& out, Faults& faults) {
  const toml::table* table = table_below(faults, root, "override", "[override.feed]");
  const bool absent = root.get("override") == nullptr;
  if (absent || (table != nullptr && table->get("feed") == nullptr)) {
    faults.add(
        absent ? 0 : line_of(table->source()), "there is no [override.feed]",
        "add the table of the feed override switch: coding and percent, or binary_max_percent");
  }
  if (table == nullptr) {
    return;
  }
  constexpr std::array<std::string_view, 3> kNames = {"feed", "rapid", "spindle"};
  for (const auto& [name, node] : *table) {
    if (std::find(kNames.begin(), kNames.end(), name.str()) == kNames.end()) {
      const std::string_view close = kernel::outcome::nearest(name.str(), kNames);
      faults.add(line_of(name.source()), fmt::format("[override] has no {}", name.str()),
                 close.empty()
                     ? "use [override.feed], [override.rapid] or [override.spindle]"
                     : fmt::format("write [override.{}] if that is what you mean", close));
    }
  }
  const bool feed = override_at(*table, "feed", faults, out.feed_override);
  if (!override_at(*table, "rapid", faults, out.rapid_override) && feed) {
    out.rapid_override = rapid_from_feed(out.feed_override);
  }
  if (!override_at(*table, "spindle", faults, out.spindle_override)) {
    out.spindle_override = without_override();
  }
}

}  // namespace steadyrest::passport
