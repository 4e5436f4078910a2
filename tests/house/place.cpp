// SPDX-License-Identifier: Apache-2.0
#include "place.hpp"

#include <algorithm>
#include <utility>

namespace house {
namespace {

/// The actual folder that a pattern with one trailing `*` covers: `adapters/*` and
/// `adapters/replay/x` give `adapters/replay`.
std::optional<std::string> covered(std::string_view pattern, std::string_view folder) {
  if (!pattern.ends_with("/*")) {
    return is_within(folder, pattern) ? std::optional(std::string(pattern)) : std::nullopt;
  }
  const std::string_view stem = pattern.substr(0, pattern.size() - 1);
  if (!folder.starts_with(stem) || folder.size() == stem.size()) {
    return std::nullopt;
  }
  return std::string(folder.substr(0, folder.find('/', stem.size())));
}

/// The shelf that a folder is on, or is itself.
std::optional<std::size_t> shelf_of(const Location& at, std::string_view folder) {
  for (std::size_t i = 0; i < at.place->shelves.size(); ++i) {
    if (is_within(folder, at.folder + "/" + at.place->shelves[i])) {
      return i;
    }
  }
  return std::nullopt;
}

}  // namespace

bool is_within(std::string_view path, std::string_view folder) {
  return path == folder ||
         (path.starts_with(folder) && path.substr(folder.size()).starts_with('/'));
}

/// The most specific place wins: contour/online before contour.
std::optional<Location> locate(const Rules& rules, std::string_view folder) {
  std::optional<Location> best;
  for (const Place& place : rules.places) {
    auto actual = covered(place.folder, folder);
    if (actual && (!best || actual->size() > best->folder.size())) {
      best = Location{&place, *std::move(actual)};
    }
  }
  return best;
}

/// Files outside the shelves are above them all.
std::size_t shelf_rank(const Location& at, std::string_view folder) {
  return shelf_of(at, folder).value_or(at.place->shelves.size());
}

std::string home_of(const Rules& rules, const std::string& folder) {
  // A room's tests share its namespace, in folders by theme too.
  std::string home = folder;
  if (const auto test = (home + "/").find("/test/"); test != std::string::npos) {
    home.resize(test);
  }
  const auto at = locate(rules, folder);
  return at && shelf_of(*at, home) ? at->folder : home;
}

std::optional<std::string> folder_under_root(const Rules& rules, std::string_view path) {
  if (!is_within(path, rules.root) || path.size() == rules.root.size()) {
    return std::nullopt;
  }
  path.remove_prefix(rules.root.size() + 1);
  return std::string(folder_of(path));
}

bool is_cpp(std::string_view path) {
  return path.ends_with(".hpp") || path.ends_with(".cpp");
}

bool is_in_cycle(const Rules& rules, std::string_view path) {
  if (has_folder(path, "test") || has_folder(path, "testing")) {
    return false;
  }
  // A plain folder name (`online`) applies anywhere, a path only there.
  return std::ranges::any_of(rules.in_cycle_folders, [&](std::string_view folder) {
    return folder.find('/') != std::string_view::npos ? is_within(path, folder)
                                                      : has_folder(path, folder);
  });
}

}  // namespace house
