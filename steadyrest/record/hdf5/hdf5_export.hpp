// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/record/record_reader.hpp>

/// A record as an HDF5 file, for the tools that read whole columns (h5py, MATLAB, Julia).
///
///   /samples/NAME    one value a cycle, exactly as recorded, or derived from the samples;
///                    attribute `unit` where it has one
///   /reasons/…       `number`, `name` of each reason that /samples/command.*_reason may have
///   /vibration       all readings in turn; /samples/vibrations says how many each cycle has
///   /events/…        `before`, `time_s`, `kind`, `text`
///   /machine_file, /program_text   the texts
/// The root's attributes are the run's: `start_utc`, `version`, `machine`, `program`, `cycle_s`,
/// `dropped`, `closed`.
namespace steadyrest::record::hdf5 {

/// The unit of a column by the ending of its name (without an index), in UTF-8; empty: none. The
/// axes' values are in mm and rad: a rotary axis has `mm` in the name and rad in the column.
[[nodiscard]] std::string_view unit_of(std::string_view column) noexcept;

/// Writes what `reader` has left into a new file; the number of samples. Refuses a file that cannot
/// be made or written, a damaged record, and what `goes_on`, asked after each sample, has ended.
[[nodiscard]] kernel::outcome::Result<std::uint64_t> write_hdf5(
    RecordReader& reader, const std::string& file,
    const std::function<bool(std::uint64_t samples)>& goes_on = [](std::uint64_t) { return true; },
    std::span<const Derived> derived = {});

}  // namespace steadyrest::record::hdf5
