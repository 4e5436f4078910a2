// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/record/columns.hpp>
#include <steadyrest/record/hdf5/hdf5_export.hpp>
#include <steadyrest/record/hdf5/hdf5_handle.hpp>

namespace steadyrest::record::hdf5 {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr hsize_t kChunk = 4096;
constexpr unsigned kDeflate = 4;

struct Unit {
  std::string_view ending;
  std::string_view unit;
};
// The longer ones first.
constexpr auto kUnits = std::to_array<Unit>({{"_mm_s2", "mm/s²"},
                                             {"_mm_s", "mm/s"},
                                             {"_rev_s", "rev/s"},
                                             {"_mm", "mm"},
                                             {"_s", "s"},
                                             {"_hz", "Hz"},
                                             {"_c", "°C"},
                                             {"_ratio", "1"}});

/// How the file keeps a column; in memory all have 64 bits.
struct Kind {
  hid_t in_file;
  hid_t in_memory;
};

template <class Value>
Kind kind_of() {
  if constexpr (std::is_same_v<Value, double>) {
    return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE};
  } else if constexpr (std::is_same_v<Value, bool> || std::is_enum_v<Value>) {
    return {H5T_STD_U16LE, H5T_NATIVE_UINT64};
  } else if constexpr (std::is_signed_v<Value>) {
    return {H5T_STD_I64LE, H5T_NATIVE_INT64};
  } else {
    return {H5T_STD_U64LE, H5T_NATIVE_UINT64};
  }
}

/// Texts of any length, UTF-8.
Hdf5Handle text_type() {
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), H5T_VARIABLE);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

bool put_attribute(hid_t at, const char* name, const std::string& text) {
  const Hdf5Handle type = text_type();
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(at, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  const char* const value = text.c_str();
  return attribute.good() &&
         H5Awrite(attribute.id(), type.id(), static_cast<const void*>(&value)) >= 0;
}

template <class Value>
bool put_attribute(hid_t at, const char* name, hid_t in_file, hid_t in_memory, Value value) {
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(at, name, in_file, space.id(), H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  return attribute.good() && H5Awrite(attribute.id(), in_memory, &value) >= 0;
}

bool put_text(hid_t at, const char* name, const std::string& text) {
  const Hdf5Handle type = text_type();
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle set(
      H5Dcreate2(at, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  const char* const value = text.c_str();
  return set.good() && H5Dwrite(set.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                static_cast<const void*>(&value)) >= 0;
}

/// Values of a known number.
bool put_array(hid_t at, const char* name, hid_t in_file, hid_t in_memory, std::size_t count,
               const void* values) {
  const hsize_t size = count;
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Hdf5Handle set(
      H5Dcreate2(at, name, in_file, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  return set.good() &&
         (count == 0 || H5Dwrite(set.id(), in_memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
}

/// A data set that grows, a block at a time.
class Column {
 public:
  static Column make(hid_t at, const ColumnName& name, Kind kind) {
    Column column;
    const hsize_t none = 0;
    const hsize_t any = H5S_UNLIMITED;
    const Hdf5Handle space(H5Screate_simple(1, &none, &any), H5Sclose);
    const Hdf5Handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(how.id(), 1, &kChunk);
    H5Pset_shuffle(how.id());
    H5Pset_deflate(how.id(), kDeflate);
    column.set_ = Hdf5Handle(H5Dcreate2(at, name.text().c_str(), kind.in_file, space.id(),
                                        H5P_DEFAULT, how.id(), H5P_DEFAULT),
                             H5Dclose);
    column.in_memory_ = kind.in_memory;
    const auto unit = unit_of(name.name);
    column.good_ = column.set_.good() &&
                   (unit.empty() || put_attribute(column.set_.id(), "unit", std::string(unit)));
    return column;
  }

  /// After a failed write it holds nothing more.
  void add(std::uint64_t bits) {
    if (!good_) {
      return;
    }
    held_.push_back(bits);
    if (held_.size() == kChunk) {
      write();
    }
  }
  void write() {
    if (held_.empty() || !good_) {
      return;
    }
    const hsize_t count = held_.size();
    const hsize_t size = written_ + count;
    good_ = H5Dset_extent(set_.id(), &size) >= 0;
    const Hdf5Handle place(H5Dget_space(set_.id()), H5Sclose);
    const Hdf5Handle block(H5Screate_simple(1, &count, nullptr), H5Sclose);
    good_ =
        good_ &&
        H5Sselect_hyperslab(place.id(), H5S_SELECT_SET, &written_, nullptr, &count, nullptr) >= 0 &&
        H5Dwrite(set_.id(), in_memory_, block.id(), place.id(), H5P_DEFAULT, held_.data()) >= 0;
    written_ = size;
    held_.clear();
  }
  [[nodiscard]] bool good() const noexcept { return good_; }

 private:
  Hdf5Handle set_;
  hid_t in_memory_ = -1;
  std::vector<std::uint64_t> held_;
  hsize_t written_ = 0;
  bool good_ = false;
};

bool put_run(hid_t file, const RecordReader& reader) {
  const RunInfo& run = reader.run();
  const Totals& totals = reader.totals();
  return put_attribute(file, "start_utc", run.start_utc) &&
         put_attribute(file, "version", run.version) &&
         put_attribute(file, "machine", run.machine) &&
         put_attribute(file, "program", run.program) &&
         put_attribute(file, "cycle_s", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, run.cycle_s) &&
         put_attribute(file, "dropped", H5T_STD_U64LE, H5T_NATIVE_UINT64, totals.dropped) &&
         put_attribute(file, "closed", H5T_STD_U8LE, H5T_NATIVE_UINT64,
                       std::uint64_t{totals.closed}) &&
         put_text(file, "machine_file", run.machine_text) &&
         put_text(file, "program_text", run.program_text);
}

bool put_events(hid_t file, const std::vector<Event>& events) {
  const Hdf5Handle group(H5Gcreate2(file, "events", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                         H5Gclose);
  std::vector<std::uint64_t> before;
  std::vector<double> time_s;
  std::vector<const char*> kind;
  std::vector<const char*> text;
  for (const Event& event : events) {
    before.push_back(event.before);
    time_s.push_back(event.time_s);
    kind.push_back(word(event.kind).data());
    text.push_back(event.text.c_str());
  }
  const Hdf5Handle type = text_type();
  const std::size_t count = events.size();
  return group.good() &&
         put_array(group.id(), "before", H5T_STD_U64LE, H5T_NATIVE_UINT64, count, before.data()) &&
         put_array(group.id(), "time_s", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, count, time_s.data()) &&
         put_array(group.id(), "kind", type.id(), type.id(), count,
                   static_cast<void*>(kind.data())) &&
         put_array(group.id(), "text", type.id(), type.id(), count,
                   static_cast<void*>(text.data()));
}

/// What the numbers of the columns command.*_reason mean.
bool put_reasons(hid_t file) {
  const Hdf5Handle group(H5Gcreate2(file, "reasons", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                         H5Gclose);
  std::vector<std::uint64_t> number;
  std::vector<std::string> texts;
  for (const kernel::outcome::ReasonEntry& entry : kernel::outcome::reasons()) {
    number.push_back(to_bits(entry.reason));
    texts.emplace_back(entry.name);
  }
  std::vector<const char*> name;
  std::ranges::transform(texts, std::back_inserter(name), &std::string::c_str);
  const Hdf5Handle type = text_type();
  return group.good() &&
         put_array(group.id(), "number", H5T_STD_U16LE, H5T_NATIVE_UINT64, number.size(),
                   number.data()) &&
         put_array(group.id(), "name", type.id(), type.id(), name.size(),
                   static_cast<void*>(name.data()));
}

std::vector<Column> columns_in(hid_t group) {
  std::vector<Column> columns;
  Sample any;
  sample_columns(any, [&](const ColumnName& name, auto& value) {
    columns.push_back(Column::make(group, name, kind_of<std::decay_t<decltype(value)>>()));
  });
  return columns;
}

}  // namespace

std::string_view unit_of(std::string_view column) noexcept {
  for (const Unit& unit : kUnits) {
    if (column.ends_with(unit.ending)) {
      return unit.unit;
    }
  }
  return {};
}

Result<std::uint64_t> write_hdf5(RecordReader& reader, const std::string& file,
                                 const std::function<bool(std::uint64_t)>& goes_on,
                                 std::span<const Derived> derived) {
  H5dont_atexit();  // at the process's end it fails on a file that a full disk has cut off
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // the refusal says it
  const auto failed = [&file] {
    return refuse(file, "cannot be written as HDF5", "look for room on the disk and permission");
  };
  Hdf5Handle out(H5Fcreate(file.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  if (!out.good() || !put_run(out.id(), reader) || !put_events(out.id(), reader.events()) ||
      !put_reasons(out.id())) {
    return failed();
  }
  Hdf5Handle group(H5Gcreate2(out.id(), "samples", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                   H5Gclose);
  auto columns = columns_in(group.id());
  for (const Derived& column : derived) {
    columns.push_back(Column::make(group.id(), {column.name}, kind_of<double>()));
  }
  Column vibration = Column::make(out.id(), {"vibration"}, kind_of<double>());
  const auto sample = std::make_unique<Sample>();
  std::uint64_t samples = 0;
  for (;;) {
    const auto more = reader.next(*sample);
    if (!more) {
      return std::unexpected(more.error());
    }
    if (!*more) {
      break;
    }
    std::size_t at = 0;
    sample_columns(*sample, [&](const ColumnName& /*name*/, auto& value) {
      columns[at++].add(to_bits(value));
    });
    for (const Derived& column : derived) {
      columns[at++].add(to_bits(column.value(*sample)));
    }
    for (std::size_t i = 0; i < sample->vibrations; ++i) {
      vibration.add(to_bits(sample->vibration[i]));
    }
    if (!goes_on(++samples)) {
      return refuse("the table was given up", "begin it again");
    }
    if (samples % kChunk == 0 &&
        !(vibration.good() && std::ranges::all_of(columns, &Column::good))) {
      break;
    }
  }
  columns.push_back(std::move(vibration));
  bool good = group.good();
  for (Column& column : columns) {
    column.write();
    good = good && column.good();
  }
  columns.clear();
  good = group.close() && good;
  good = out.close() && good;
  return good ? Result<std::uint64_t>(samples) : failed();
}

}  // namespace steadyrest::record::hdf5
