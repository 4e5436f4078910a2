// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include <steadyrest/supervisor/wish.hpp>

namespace steadyrest::supervisor {

/// A wish and its outcome as a line of a record. Every number comes back with the same bits:
///   modulate LAW AMPLITUDE_RATIO AMPLITUDE_REV_S PERIOD_S MEAN_RATIO SEED OUTCOME AUTHOR
///   measure AXIS NAME DISPLACEMENT_MM SD_MM OUTCOME AUTHOR
/// AXIS counts the machine's axes from 0.
using WishText = ShortText<240>;

/// In the cycle.
[[nodiscard]] WishText text_of(const Wish& wish, WishOutcome outcome) noexcept;

struct RecordedWish {
  Wish wish;
  WishOutcome outcome = WishOutcome::taken;
};

/// None for a line that is no wish.
[[nodiscard]] std::optional<RecordedWish> wish_of(std::string_view text) noexcept;

/// `taken`, `rejected`, `room_off`, `no_model`, `out_of_range`, `listening`.
[[nodiscard]] std::string_view word(WishOutcome outcome) noexcept;

}  // namespace steadyrest::supervisor
