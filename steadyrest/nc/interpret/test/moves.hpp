// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/program.hpp>

namespace steadyrest::nc::interpret {

/// rs274 prints four decimals.
inline constexpr double kHalfDigit = 0.00005 + 1e-9;

/// Keeps everything a program sends.
struct Kept final : public Sink {
  std::vector<Move> moves;
  std::vector<Event> events;
  void on_move(const Move& move) override { moves.push_back(move); }
  void on_event(const Event& event) override { events.push_back(event); }
};

/// The moves of a text that must be accepted.
inline std::vector<Move> moves_of(std::string_view text, const Config& config = {}) {
  Kept kept;
  const auto report = run_text(text, config, kept);
  EXPECT_TRUE(report.has_value());
  if (report && !report->refused.empty()) {
    ADD_FAILURE() << report->refused.front().line << ' ' << report->refused.front().word << ": "
                  << report->refused.front().text;
  }
  return kept.moves;
}

/// Where each of the moves ends on one axis.
inline std::vector<double> ends_along(std::size_t axis, std::string_view text,
                                      const Config& config) {
  std::vector<double> out;
  for (const Move& move : moves_of(text, config)) {
    out.push_back(move.end[axis]);
  }
  return out;
}

/// Identifier of the first refusal; empty when the text is accepted.
inline std::string reason_of(std::string_view text, const Config& config = {}) {
  Kept kept;
  const auto report = run_text(text, config, kept);
  return !report || report->refused.empty() ? std::string{} : report->refused.front().reason;
}

}  // namespace steadyrest::nc::interpret
