// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <optional>
#include <string_view>

#include <steadyrest/chatter/offline/signal/signal_file.hpp>
#include <steadyrest/table/text.hpp>

/// The three formats of a recorded signal, and what their readers share.
namespace steadyrest::chatter::offline {

inline constexpr double kLeastRateHz = 1e3;
inline constexpr double kMostRateHz = 1e6;

using SignalFault = table::Fault;
template <class T>
using OrFault = std::expected<T, SignalFault>;

/// A rate that is not read, with room for rounded time stamps.
[[nodiscard]] std::optional<SignalFault> unfit_rate(double rate_hz);

[[nodiscard]] OrFault<RecordedChannels> parse_csv_signals(std::string_view text,
                                                          const table::Format& format);
/// A universal file.
[[nodiscard]] OrFault<RecordedChannels> parse_uff_signals(std::string_view text);
/// `bytes` begin with RIFF.
[[nodiscard]] OrFault<RecordedChannels> parse_wav_signals(std::string_view bytes);

}  // namespace steadyrest::chatter::offline
