// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/supervisor/wish.hpp>

/// Wishes as the page's clients and the socket's write them.
namespace steadyrest::live {

using Json = nlohmann::ordered_json;

/// Of a client's words, as much as a message needs.
[[nodiscard]] std::string shown(const Json& value);
/// `law`, `amplitude_ratio`, `period_s`, `mean_ratio`.
[[nodiscard]] Json modulation_json(const chatter::online::Modulation& modulation);

/// From the keys of modulation_json(), all of them; the random law keeps the seed of the machine
/// file. Refused: a chatter room that is off, what is missing, no number or out of range.
[[nodiscard]] kernel::outcome::Result<supervisor::Wish> modulation_wish(
    const Json& keys, const kernel::machine::Machine& machine, std::string_view author);
/// From `axis` (its name), `displacement_um`, `sd_um`. Refused: a thermal room that is off, an axis
/// without a thermal model, what is missing, no number or out of range.
[[nodiscard]] kernel::outcome::Result<supervisor::Wish> measured_wish(
    const Json& keys, const kernel::machine::Machine& machine, std::string_view author);

/// What Loop::ask() has answered: `taken` or `rejected`. Refused: a loop that does not cycle, a
/// room that is off or does not take it.
[[nodiscard]] kernel::outcome::Result<supervisor::WishOutcome> granted(
    std::optional<supervisor::WishOutcome> outcome);
/// Of a reading: `taken`, the `reason` and its `sentence`.
[[nodiscard]] Json verdict_json(supervisor::WishOutcome outcome);

}  // namespace steadyrest::live
