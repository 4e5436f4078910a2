// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <steadyrest/chatter/offline/signal/signal_speed_name.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/table/number.hpp>

// A number in the name is taken whole: in S5000 the pattern *{rpm} finds no 000.
namespace steadyrest::chatter::offline {
namespace {

constexpr std::string_view kPlace = "{rpm}";

bool digit(char c) {
  return c >= '0' && c <= '9';
}

/// Whether a text fits a pattern of letters and `*`.
bool fits(std::string_view text, std::string_view pattern) {
  std::size_t at = 0;
  std::size_t in = 0;
  std::size_t star = std::string_view::npos;
  std::size_t again = 0;
  while (at < text.size()) {
    if (in < pattern.size() && pattern[in] == '*') {
      star = in++;
      again = at;
    } else if (in < pattern.size() && pattern[in] == text[at]) {
      ++in;
      ++at;
    } else if (star != std::string_view::npos) {
      in = star + 1;
      at = ++again;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', in) == std::string_view::npos;
}

/// Behind the number that begins at `begin`.
std::size_t end_of_number(std::string_view name, std::size_t begin) {
  std::size_t end = begin;
  while (end < name.size() && digit(name[end])) {
    ++end;
  }
  if (end + 1 < name.size() && name[end] == '.' && digit(name[end + 1])) {
    for (++end; end < name.size() && digit(name[end]);) {
      ++end;
    }
  }
  return end;
}

}  // namespace

kernel::outcome::Result<double> speed_rpm_in_name(std::string_view path, std::string_view pattern) {
  const std::string name = std::filesystem::path(path).filename().string();
  const std::size_t place = pattern.find(kPlace);
  if (place == std::string_view::npos ||
      pattern.find(kPlace, place + 1) != std::string_view::npos) {
    return kernel::outcome::refuse(
        fmt::format("--speed-from-name \"{}\" must have {{rpm}} once", pattern),
        "write {rpm} where the file's name has the speed in rev/min, and * for anything");
  }
  const std::string_view before = pattern.substr(0, place);
  const std::string_view behind = pattern.substr(place + kPlace.size());
  std::vector<double> found;
  for (std::size_t i = 0; i < name.size();) {
    if (!digit(name[i])) {
      ++i;
      continue;
    }
    const std::size_t end = end_of_number(name, i);
    const auto rpm = table::plain_number(std::string_view(name).substr(i, end - i));
    if (rpm && fits(std::string_view(name).substr(0, i), before) &&
        fits(std::string_view(name).substr(end), behind) &&
        std::ranges::find(found, *rpm) == found.end()) {
      found.push_back(*rpm);
    }
    i = end;
  }
  const std::string file(path);
  if (found.empty()) {
    return kernel::outcome::refuse(
        file, fmt::format(R"(the name "{}" does not fit --speed-from-name "{}")", name, pattern),
        "write {rpm} where the name has a number, * for anything, and the rest as it is; quote "
        "the pattern in a shell");
  }
  if (found.size() > 1) {
    return kernel::outcome::refuse(file,
                                   fmt::format(R"("{}" fits --speed-from-name "{}" with {})", name,
                                               pattern, fmt::join(found, " and ")),
                                   "write more of the name around {rpm}");
  }
  if (!(found.front() > 0.0)) {
    return kernel::outcome::refuse(file,
                                   fmt::format("the speed in the name \"{}\" is not above 0", name),
                                   "give the speed with --speed-rpm");
  }
  return found.front();
}

}  // namespace steadyrest::chatter::offline
