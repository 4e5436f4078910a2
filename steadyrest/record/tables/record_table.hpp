// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/record/record_reader.hpp>

/// A record as a table for other programs.
namespace steadyrest::record::tables {

/// How the first line of a CSV begins; all of them are the names of columns.hpp.
inline constexpr std::string_view kCsvHead = "number,path,vibrations,time_s";

/// Asked after each sample; false ends the work, which is then refused.
using GoesOn = std::function<bool(std::uint64_t samples)>;

/// Gives what `reader` has left to `out`, line by line; the number of samples. Each number is the
/// shortest text that reads back as the same; enumerations and yes/no are numbers. Behind the
/// recorded columns come the `derived` ones and the names of the reasons
/// (`command.feed_reason_name`, …). Refuses a damaged record.
[[nodiscard]] kernel::outcome::Result<std::uint64_t> write_csv(
    RecordReader& reader, const std::function<void(std::string_view)>& out, const GoesOn& goes_on,
    std::span<const Derived> derived);

/// Whether this program was built with HDF5.
[[nodiscard]] bool has_hdf5() noexcept;

/// Writes what `reader` has left into a new HDF5 file (record/hdf5); the number of samples. One at
/// a time in the process: the library is not for several threads. Refuses a file that cannot be
/// written, a damaged record, and everything in a program without HDF5.
[[nodiscard]] kernel::outcome::Result<std::uint64_t> write_hdf5(RecordReader& reader,
                                                                const std::string& file,
                                                                const GoesOn& goes_on,
                                                                std::span<const Derived> derived);

}  // namespace steadyrest::record::tables
