// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/nc/rewrite/prove/verify.hpp>

namespace steadyrest::nc::rewrite {

/// A proof for one position of block delete.
struct Proved {
  Proof proof;
  bool switchable =
      false;  ///< the program has lines with `/`: the other position needs its own proof
};

/// What is to be proved, for verify().
struct Claim {
  const std::string& original;
  const std::string& changed;
  const Plan& plan;
  const kernel::machine::Machine& machine;
  const Settings& settings;
  const KnownTimes* known = nullptr;
};

/// verify() for a correction within the program's positions: runs both programs side by side, line
/// by line, and compares their moves. `timed`: also proves that all corrections act, and within
/// their windows; else only that those that act are right wherever the program ends.
[[nodiscard]] kernel::outcome::Result<Proved> verify_moves(const Claim& claim,
                                                           const interpret::Config& config,
                                                           bool timed);

}  // namespace steadyrest::nc::rewrite
