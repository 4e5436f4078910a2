// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/table/row_reader.hpp>

/// Reader of a recorded vibration, sound or power: CSV, WAV or UFF, recognised by the first bytes.
///
/// CSV: a column of times (`t_s`, `Time (s)`, `timestamp [ms]`, stamps of ISO 8601, sample numbers)
/// or rows at a rate that is given; if recorded, one of the spindle's speed (`speed_rpm`, `RPM`,
/// `n (1/min)`, `Spindle speed (rev/s)`); every other column of numbers is a channel, or `value`
/// alone, if a column is named so (signal_columns.hpp). Lines of words before the header are
/// skipped; without a header two columns are time and value (signal_layout.hpp). The rest is
/// table::RowReader's.
///
/// Fields that are empty or not finite, and samples that are missing in a gap of up to 1 s
/// (signal_times.hpp), are NaN in `value`; a speed holds for up to 1 s and is NaN behind that.
///
/// WAV: RIFF with PCM of 8, 16, 24 or 32 bits or floats of 32 or 64, of any number of channels,
/// also as WAVE_FORMAT_EXTENSIBLE; PCM in ±1. It has no speed. Layout: Multimedia Programming
/// Interface and Data Specifications 1.0 (IBM, Microsoft, 1991); Multiple Channel Audio Data and
/// WAVE Files (Microsoft, 2007).
///
/// UFF: time responses (function type 1) of dataset 58 or 58b, each a channel; other functions are
/// skipped with a note. All must have one rate, start and length. It has no speed.
///
/// Rates above the detector's 50 kHz are divided by the least whole number that brings them below
/// it, through a low-pass filter (signal_rate.hpp).
///
/// Refused, with line or byte: any other format, words among numbers, a truncated file, uneven
/// times, a rate outside 1 kHz … 1 MHz or other than the given one, over 256 MB. Nothing throws.
namespace steadyrest::chatter::offline {

struct RecordedSignal {
  std::size_t channel = 1;          ///< of the file, from 1
  std::string name;                 ///< as the file calls it, without its unit; empty: it does not
  std::string unit;                 ///< as written; empty: none
  std::string written;              ///< the name's other form: with its unit, or as a UFF's point
  double recorded_hz = 0.0;         ///< 1e3 … 1e6
  double rate_hz = 0.0;             ///< of the values: 1e3 … 50e3
  double start_s = 0.0;             ///< time of the first sample
  std::vector<double> value;        ///< ≥ 2, any unit; NaN: not recorded
  std::vector<double> speed_rev_s;  ///< ≥ 0 or NaN, as many; empty: not recorded
  std::vector<std::string> notes;   ///< what was assumed, left out or missing
};

/// The file's channels, one at least, all of one length and rate.
using RecordedChannels = std::vector<RecordedSignal>;

[[nodiscard]] kernel::outcome::Result<RecordedChannels> read_signals(
    const std::string& path, const table::Format& format = {});

/// The same from bytes; `file` is the name in refusals.
[[nodiscard]] kernel::outcome::Result<RecordedChannels> parse_signals(
    std::string_view bytes, const std::string& file, const table::Format& format = {});

/// The finite ones among values; least > most: there are none.
struct FiniteRange {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
};
[[nodiscard]] FiniteRange finite_range(const std::vector<double>& values) noexcept;

/// Signals that can be read but not judged: every sample the same (a dead, saturated or unplugged
/// sensor), or amplitudes whose squares, summed over a window, overflow a double.
[[nodiscard]] std::optional<kernel::outcome::Refusal> no_signal(const RecordedSignal& signal,
                                                                const std::string& file);

}  // namespace steadyrest::chatter::offline
