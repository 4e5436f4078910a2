// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/nc/interpret/test/moves.hpp>

/// SINUMERIK programs.
namespace steadyrest::nc::interpret::test {

inline Config sinumerik() {
  Config config;
  config.dialect = read::Dialect::sinumerik;
  return config;
}

inline std::vector<double> along(std::size_t axis, const std::string& text,
                                 const Config& config = sinumerik()) {
  return ends_along(axis, text, config);
}
inline std::vector<double> sinumerik_x_of(const std::string& text,
                                          const Config& config = sinumerik()) {
  return ends_along(0, text, config);
}
inline std::string reason_of_block(const std::string& text) {
  return reason_of(text + "\nM30\n", sinumerik());
}

}  // namespace steadyrest::nc::interpret::test
