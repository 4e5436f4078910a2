// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/nc/rewrite/prove/verify.hpp>

namespace steadyrest::nc::rewrite {

/// A proof for one position of block delete.
struct Proved {
  Proof proof;
  bool switchable =
      false;  ///< the program has lines with `/`: the other position is another matter
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

/// verify() for a correction that the positions of the program know of: both programs are run, line
/// beside line, and their moves compared. `timed`: that corrections act in their windows is shown
/// too, and that all of them act; else that what acts is right wherever the program ends.
[[nodiscard]] kernel::outcome::Result<Proved> verify_moves(const Claim& claim,
                                                           const interpret::Config& config,
                                                           bool timed);

}  // namespace steadyrest::nc::rewrite
