// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <steadyrest/nc/rewrite/prove/verify.hpp>
#include <steadyrest/nc/rewrite/prove/verify_beside.hpp>
#include <steadyrest/nc/rewrite/prove/verify_moves.hpp>

namespace steadyrest::nc::rewrite {

using kernel::outcome::Result;

// The operator's switch may be in either position when the changed program runs, so the program is
// proved in both. Times and windows are those of the requested position.
Result<Proof> verify(const std::string& original, const std::string& changed, const Plan& plan,
                     const interpret::Config& config, const kernel::machine::Machine& machine,
                     const Settings& settings, const KnownTimes* known) {
  if (auto checked = check_plan(plan, settings, config); !checked) {
    return std::unexpected(checked.error());
  }
  const auto prove = beside_program(settings.method) ? verify_beside : verify_moves;
  Claim claim{original, changed, plan, machine, settings, known};
  auto proved = prove(claim, config, true);
  if (!proved) {
    return std::unexpected(proved.error());
  }
  if (proved->switchable) {
    claim.known = nullptr;
    auto other = prove(claim, switched(config), false);
    if (!other) {
      return std::unexpected(of_other_position(std::move(other.error()), config));
    }
  }
  return proved->proof;
}

}  // namespace steadyrest::nc::rewrite
