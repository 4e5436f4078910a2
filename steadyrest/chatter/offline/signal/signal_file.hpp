// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/table/row_reader.hpp>

/// Reader of a recorded vibration, sound or power: CSV or WAV, recognised by the first bytes.
///
/// CSV: columns `t_s`, `value` and, if recorded, `speed_rpm`, found by name among others, as read
/// by table::RowReader; times may also be stamps (ISO 8601) or sample numbers. Each time step must
/// be within 25 % of the median: no sample may be missing.
///
/// WAV: RIFF with PCM of 16, 24 or 32 bits or floats of 32, of any number of channels; values in
/// ±1. It has no speed. Layout: Multimedia Programming Interface and Data Specifications 1.0
/// (IBM, Microsoft, 1991).
///
/// Rates above the detector's 50 kHz are divided by the least whole number that brings them below
/// it, through a low-pass filter (signal_rate.hpp).
///
/// Refused, with line or byte: any other format, a value that is not finite, a truncated file, a
/// rate outside 1 kHz … 1 MHz, over 256 MB. Nothing throws.
namespace steadyrest::chatter::offline {

struct RecordedSignal {
  std::size_t channel = 1;          ///< of the file, from 1
  double recorded_hz = 0.0;         ///< 1e3 … 1e6
  double rate_hz = 0.0;             ///< of the values: 1e3 … 50e3
  double start_s = 0.0;             ///< time of the first sample
  std::vector<double> value;        ///< ≥ 2, any unit
  std::vector<double> speed_rev_s;  ///< ≥ 0, as many; empty: not recorded
};

/// The file's channels, one at least, all of one length and rate.
using RecordedChannels = std::vector<RecordedSignal>;

[[nodiscard]] kernel::outcome::Result<RecordedChannels> read_signals(
    const std::string& path, const table::Format& format = {});

/// The same from bytes; `file` is the name in refusals.
[[nodiscard]] kernel::outcome::Result<RecordedChannels> parse_signals(
    std::string_view bytes, const std::string& file, const table::Format& format = {});

/// Signals that can be read but not judged: every sample the same (a dead, saturated or unplugged
/// sensor), or amplitudes whose squares, summed over a window, overflow a double.
[[nodiscard]] std::optional<kernel::outcome::Refusal> no_signal(const RecordedSignal& signal,
                                                                const std::string& file);

}  // namespace steadyrest::chatter::offline
