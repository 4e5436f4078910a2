// SPDX-License-Identifier: Apache-2.0
#include <iterator>
#include <memory>
#include <mutex>
#include <type_traits>

#include <fmt/format.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/record/columns.hpp>
#include <steadyrest/record/tables/record_table.hpp>
#if STEADYREST_HAS_HDF5
#include <steadyrest/record/hdf5/hdf5_export.hpp>
#endif

namespace steadyrest::record::tables {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

template <class Value>
constexpr bool kIsReason = std::is_same_v<Value, kernel::outcome::Reason>;

std::string head(Sample& sample, std::span<const Derived> derived) {
  std::string line;
  std::string names;
  sample_columns(sample, [&](const ColumnName& name, auto& value) {
    line += (line.empty() ? "" : ",") + name.text();
    if constexpr (kIsReason<std::decay_t<decltype(value)>>) {
      names += "," + name.text() + "_name";
    }
  });
  for (const Derived& column : derived) {
    line += "," + column.name;
  }
  return line + names + "\n";
}

void put_row(Sample& sample, std::span<const Derived> derived, std::string& line) {
  line.clear();
  sample_columns(sample, [&line](const ColumnName& /*name*/, auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if (!line.empty()) {
      line += ',';
    }
    if constexpr (std::is_same_v<Value, double>) {
      fmt::format_to(std::back_inserter(line), "{}", value);
    } else if constexpr (std::is_signed_v<Value>) {
      fmt::format_to(std::back_inserter(line), "{}", std::int64_t{value});
    } else {
      fmt::format_to(std::back_inserter(line), "{}", to_bits(value));
    }
  });
  for (const Derived& column : derived) {
    fmt::format_to(std::back_inserter(line), ",{}", column.value(sample));
  }
  sample_columns(sample, [&line](const ColumnName& /*name*/, auto& value) {
    if constexpr (kIsReason<std::decay_t<decltype(value)>>) {
      line += ',';
      line += kernel::outcome::name(value);
    }
  });
  line += '\n';
}

}  // namespace

Result<std::uint64_t> write_csv(RecordReader& reader,
                                const std::function<void(std::string_view)>& out,
                                const GoesOn& goes_on, std::span<const Derived> derived) {
  const auto sample = std::make_unique<Sample>();
  out(head(*sample, derived));
  std::uint64_t samples = 0;
  for (std::string line;;) {
    const auto more = reader.next(*sample);
    if (!more) {
      return std::unexpected(more.error());
    }
    if (!*more) {
      return samples;
    }
    put_row(*sample, derived, line);
    out(line);
    if (!goes_on(++samples)) {
      return refuse("the table was given up", "begin it again");
    }
  }
}

#if STEADYREST_HAS_HDF5
bool has_hdf5() noexcept {
  return true;
}

Result<std::uint64_t> write_hdf5(RecordReader& reader, const std::string& file,
                                 const GoesOn& goes_on, std::span<const Derived> derived) {
  static std::mutex one_at_a_time;
  const std::scoped_lock lock(one_at_a_time);
  return hdf5::write_hdf5(reader, file, goes_on, derived);
}
#else
bool has_hdf5() noexcept {
  return false;
}

Result<std::uint64_t> write_hdf5(RecordReader& /*reader*/, const std::string& file,
                                 const GoesOn& /*goes_on*/, std::span<const Derived> /*derived*/) {
  return refuse(file, "this program was built without HDF5",
                "build it with libhdf5-dev installed, or write CSV");
}
#endif

}  // namespace steadyrest::record::tables
