// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <expected>
#include <optional>
#include <string>
#include <string_view>

#include <steadyrest/chatter/offline/signal_file.hpp>

/// The two formats of a recorded signal, and what their readers share.
namespace steadyrest::chatter::offline {

inline constexpr double kLeastRateHz = 1e3;
inline constexpr double kMostRateHz = 50e3;

/// What is wrong, where, and the way out.
struct SignalFault {
  std::size_t line = 0;  ///< 0 = the file as a whole
  std::string what;
  std::string to_do;
};
template <class T>
using OrFault = std::expected<T, SignalFault>;

/// A rate outside of what the detector takes, with room for the rounding of time stamps.
[[nodiscard]] std::optional<SignalFault> unfit_rate(double rate_hz);

/// At most 40 characters, with nothing that a terminal would act on.
[[nodiscard]] std::string shown(std::string_view text);

[[nodiscard]] OrFault<RecordedSignal> parse_csv_signal(std::string_view text);
/// `bytes` begin with RIFF.
[[nodiscard]] OrFault<RecordedSignal> parse_wav_signal(std::string_view bytes);

}  // namespace steadyrest::chatter::offline
