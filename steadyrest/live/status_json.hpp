// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/live/live_status.hpp>
#include <steadyrest/live/loop.hpp>
#include <steadyrest/live/reloader.hpp>
#include <steadyrest/live/wish/wish_json.hpp>

namespace steadyrest::live {

[[nodiscard]] std::string_view word(kernel::machine::Mode mode) noexcept;
/// None for a word that is no mode.
[[nodiscard]] std::optional<kernel::machine::Mode> mode_of(std::string_view word) noexcept;

/// The keys of `status` (docs/live-protocol.md); µm, percent.
[[nodiscard]] Json status_json(const LiveStatus& status);
/// `number`, `utc`, `outcome`, `words`; null before the first.
[[nodiscard]] Json reload_json(const ReloadStatus& status);
/// `cycles`, `overruns`, `work_p50_us`, `work_p999_us`, `lateness_p999_us`, `over_limit_s`,
/// `port_faults`, `handed_back`, `reasons{}` with the cycles of each.
[[nodiscard]] Json figures_json(const LoopFigures& figures);

}  // namespace steadyrest::live
