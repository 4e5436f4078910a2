// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/record/columns.hpp>
#include <steadyrest/record/hdf5/hdf5_export.hpp>
#include <steadyrest/record/hdf5/hdf5_handle.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/test/samples.hpp>

// What is written is read back by the library itself.
namespace steadyrest::record::hdf5 {
namespace {

constexpr std::size_t kSamples = 4200;  // more than a block

/// A record of any values, and its export.
struct Exported {
  Exported() {
    test::Random random(11);
    {
      const auto writer =
          RecordWriter::make(
              {.file = folder.file("run.sqlite"),
               .info = {.machine = "mill", .machine_text = "name = \"mill\"\n", .cycle_s = 0.004}})
              .value();
      writer->event(EventKind::mode, "act");
      for (std::size_t i = 0; i < kSamples; ++i) {
        samples.push_back(test::any_sample(random));
        test::add(*writer, samples.back());
        if (i % 1000 == 0) {
          writer->flush();
        }
      }
      writer->event(EventKind::reload, writer->hold(std::string(1000, 'x')));
    }
    auto reader = RecordReader::open(folder.file("run.sqlite")).value();
    const auto written = write_hdf5(reader, folder.file("run.h5"));
    EXPECT_EQ(written.value(), kSamples);
    file =
        Hdf5Handle(H5Fopen(folder.file("run.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  }

  [[nodiscard]] std::vector<std::uint64_t> column(const std::string& name, hid_t type) const {
    const Hdf5Handle set(H5Dopen2(file.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
    const Hdf5Handle space(H5Dget_space(set.id()), H5Sclose);
    std::vector<std::uint64_t> values(
        static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())));
    EXPECT_GE(H5Dread(set.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
    return values;
  }
  [[nodiscard]] std::vector<std::string> texts(const std::string& name) const {
    const Hdf5Handle set(H5Dopen2(file.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
    const Hdf5Handle space(H5Dget_space(set.id()), H5Sclose);
    const Hdf5Handle type(H5Dget_type(set.id()), H5Tclose);
    std::vector<char*> read(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())));
    EXPECT_GE(H5Dread(set.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                      static_cast<void*>(read.data())),
              0);
    std::vector<std::string> all(read.begin(), read.end());
    H5Dvlen_reclaim(type.id(), space.id(), H5P_DEFAULT, static_cast<void*>(read.data()));
    return all;
  }
  [[nodiscard]] std::string attribute(const std::string& at, const char* name) const {
    const Hdf5Handle found(H5Aopen_by_name(file.id(), at.c_str(), name, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    if (!found.good()) {
      return "none";
    }
    const Hdf5Handle type(H5Aget_type(found.id()), H5Tclose);
    char* text = nullptr;
    H5Aread(found.id(), type.id(), static_cast<void*>(&text));
    std::string out = text;
    H5free_memory(text);
    return out;
  }

  const test::Folder folder;
  std::vector<Sample> samples;
  Hdf5Handle file;
};

// One test, since it takes a while to write.
TEST(Hdf5Export, EveryColumnComesBackBitForBitWithUnitsEventsAndTheMachine) {
  const Exported of;
  std::vector<std::vector<std::uint64_t>> expected;
  std::vector<std::string> names;
  std::vector<hid_t> types;
  std::uint64_t number = 0;
  for (Sample sample : of.samples) {
    sample.number = number++;
    sample.path = 0;
    std::size_t at = 0;
    sample_columns(sample, [&](const ColumnName& name, auto& value) {
      if (expected.size() == at) {
        expected.emplace_back();
        names.push_back("/samples/" + name.text());
        using Value = std::decay_t<decltype(value)>;
        types.push_back(std::is_same_v<Value, double> ? H5T_NATIVE_DOUBLE
                        : std::is_signed_v<Value>     ? H5T_NATIVE_INT64
                                                      : H5T_NATIVE_UINT64);
      }
      expected[at++].push_back(to_bits(value));
    });
  }
  ASSERT_GT(names.size(), 100U);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(of.column(names[i], types[i]), expected[i]) << names[i];
  }
  std::vector<std::uint64_t> vibration;
  for (const Sample& sample : of.samples) {
    for (std::size_t i = 0; i < sample.vibrations; ++i) {
      vibration.push_back(to_bits(sample.vibration[i]));
    }
  }
  EXPECT_EQ(of.column("/vibration", H5T_NATIVE_DOUBLE), vibration);
  EXPECT_EQ(of.attribute("/samples/axis.actual_mm.0", "unit"), "mm");
  EXPECT_EQ(of.attribute("/samples/axis.acceleration_mm_s2.1", "unit"), "mm/s²");
  EXPECT_EQ(of.attribute("/samples/spindle_actual_rev_s", "unit"), "rev/s");
  EXPECT_EQ(of.attribute("/samples/temperature_c.0", "unit"), "°C");
  EXPECT_EQ(of.attribute("/samples/command.feed_ratio", "unit"), "1");
  EXPECT_EQ(of.attribute("/samples/program_line", "unit"), "none");
  EXPECT_EQ(of.attribute("/", "machine"), "mill");
  EXPECT_EQ(of.texts("/events/kind"), (std::vector<std::string>{"mode", "reload"}));
  EXPECT_EQ(of.texts("/events/text"), (std::vector<std::string>{"act", std::string(1000, 'x')}));
  EXPECT_EQ(of.column("/events/before", H5T_NATIVE_UINT64),
            (std::vector<std::uint64_t>{0, kSamples}));
  EXPECT_EQ(of.texts("/machine_file"), (std::vector<std::string>{"name = \"mill\"\n"}));
  auto reader = RecordReader::open(of.folder.file("run.sqlite")).value();
  EXPECT_FALSE(write_hdf5(reader, of.folder.file("run.h5")));
  EXPECT_FALSE(write_hdf5(reader, of.folder.file("none/run.h5")));
}

}  // namespace
}  // namespace steadyrest::record::hdf5
