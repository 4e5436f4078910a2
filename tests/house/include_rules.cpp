// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "file_check.hpp"
#include "place.hpp"

// What a file may include.
namespace house {
namespace {

/// `*` permits everything (apps, tests).
bool is_permitted(const Place& place, std::string_view target_folder) {
  return std::ranges::any_of(place.includes, [&](std::string_view allowed) {
    return allowed == "*" || is_within(target_folder, allowed);
  });
}

bool header_matches(std::string_view pattern, std::string_view header) {
  return pattern.ends_with('*') ? header.starts_with(pattern.substr(0, pattern.size() - 1))
                                : header == pattern;
}

/// Within a place with shelves only lower ones may be included, so that the order stays a line and
/// never a circle. Tests may use the helpers of other tests.
void check_shelf(FileCheck& check, const Location& here, const std::string& target,
                 const Include& include) {
  if (has_folder(check.file.path, "test") || has_folder(include.target, "test")) {
    return;
  }
  if (shelf_rank(here, target) > shelf_rank(here, check.folder)) {
    check.report("shelf", include.line,
                 check.folder + " must not include " + include.target + ", a higher shelf of " +
                     here.folder);
  }
}

void check_floor(FileCheck& check, const Location& here, const std::string& target,
                 const Include& include) {
  const auto there = locate(check.rules, target);
  if (!there) {
    check.report("place", include.line, include.target + " has no place in floors.toml");
    return;
  }
  // Inside its own place the shelves decide, between places the floors.
  if (is_within(target, here.folder)) {
    check_shelf(check, here, target, include);
    return;
  }
  // Both conditions: a list that mistakenly permits a higher floor must not win.
  const bool higher = there->place->floor > here.place->floor;
  if (higher || !is_permitted(*here.place, target)) {
    check.report("floor", include.line,
                 here.folder + " (F" + std::to_string(here.place->floor) + ") must not include " +
                     include.target + " (F" + std::to_string(there->place->floor) + ")");
  }
}

/// The name of the half decides, wherever it occurs in the path.
void check_half(FileCheck& check, const std::string& target, const Include& include) {
  if (has_folder(check.file.path, "online") && has_folder(target + "/", "offline")) {
    check.report("half", include.line, "online must not include offline: " + include.target);
  }
}

void check_in_cycle_header(FileCheck& check, const Include& include) {
  for (const std::string& pattern : check.rules.in_cycle_headers) {
    if (header_matches(pattern, include.target)) {
      check.report("in-cycle", include.line,
                   "<" + include.target + "> has no business in the cycle");
    }
  }
}

}  // namespace

void check_includes(FileCheck& check) {
  const auto here = locate(check.rules, check.folder);
  if (!here) {
    check.report("place", 1, "the folder " + check.folder + " has no place in floors.toml");
    return;
  }
  const bool in_cycle = is_in_cycle(check.rules, check.file.path);
  for (const Include& include : includes(check.file.text)) {
    if (in_cycle) {
      // Locks, streams and clocks come in by their headers.
      check_in_cycle_header(check, include);
    }
    const auto target = folder_under_root(check.rules, include.target);
    if (target) {
      check_floor(check, *here, *target, include);
      check_half(check, *target, include);
    } else if (include.quoted) {
      check.report("quoted-include", include.line,
                   "\"" + include.target + "\": own headers are <" + check.rules.root + "/…>");
    }
  }
}

}  // namespace house
