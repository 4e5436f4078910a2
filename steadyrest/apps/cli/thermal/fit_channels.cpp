// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/core.h>

#include <steadyrest/apps/cli/thermal/fit_channels.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::apps::cli {
namespace {

using kernel::outcome::refuse;
using thermal::offline::Log;

/// The column name of an axis without its unit: Z for z_um, ch1 for ch1_um.
std::string axis_of(const std::string& column) {
  const bool unit = column.size() > 3 && (column.ends_with("_um") || column.ends_with("_mm"));
  std::string name = unit ? column.substr(0, column.size() - 3) : column;
  // Machine files name axes by capital letters.
  if (name.size() == 1 && name.front() >= 'a' && name.front() <= 'z') {
    name.front() = static_cast<char>(name.front() - 'a' + 'A');
  }
  return name;
}

constexpr std::size_t kLongestName = 32;  ///< in a passport

bool is_of_a_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

}  // namespace

/// Which columns are fitted, and the names of their axes in the passport.
kernel::outcome::Result<FitChannels> fit_channels(const std::vector<std::string>& wanted,
                                                  const Log& log) {
  FitChannels out;
  // NAME or NAME=AXIS, as everywhere on this command line.
  for (const std::string& given : wanted) {
    const std::size_t at = given.find('=');
    const std::string name = given.substr(0, at);
    const auto found =
        std::ranges::find(log.displacement, name, &thermal::offline::LogChannel::name);
    if (found == log.displacement.end()) {
      return refuse(log.file, fmt::format("there is no displacement {}", name),
                    "name a column of the log, as --channel z_um=Z");
    }
    std::string axis = at == std::string::npos ? axis_of(name) : given.substr(at + 1);
    if (axis.empty() || axis.size() > kLongestName || !std::ranges::all_of(axis, is_of_a_name)) {
      return refuse(fmt::format("--channel {} names no axis", given),
                    "write the axis after =, as --channel z_um=Z; or a name of "
                    "letters, digits and _ if no axis corrects it");
    }
    out.emplace_back(found - log.displacement.begin(), std::move(axis));
  }
  // Nothing named: every displacement of the log, each with the axis that its column suggests.
  for (std::size_t i = 0; i < log.displacement.size() && wanted.empty(); ++i) {
    out.emplace_back(i, axis_of(log.displacement[i].name));
  }
  // Two columns for one axis would overwrite each other in the passport. There are few, so
  // comparing pairs will do.
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (out[i].first == out[j].first) {
        return refuse(fmt::format("--channel {} is given twice",
                                  log.displacement[static_cast<std::size_t>(out[i].first)].name),
                      "name each column once");
      }
      if (out[i].second == out[j].second) {
        return refuse(fmt::format("two channels are called {}", out[i].second),
                      "give each a different name");
      }
    }
  }
  return out;
}

}  // namespace steadyrest::apps::cli
