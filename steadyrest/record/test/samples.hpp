// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/record/columns.hpp>
#include <steadyrest/record/record_writer.hpp>
#include <steadyrest/record/sample.hpp>

namespace steadyrest::record::test {

/// A folder of the running test's own, removed with this object.
class Folder {
 public:
  [[nodiscard]] std::string path() const { return own_.path().string(); }
  [[nodiscard]] std::string file(const std::string& name) const { return own_.at(name); }

 private:
  kernel::file::testing::OwnFolder own_;
};

using Random = std::mt19937_64;

/// Any value of the type, for doubles the awkward ones too.
template <class T>
void randomize(Random& random, T& value) {
  const std::uint64_t bits = random();
  if constexpr (std::is_same_v<T, double>) {
    using Limits = std::numeric_limits<double>;
    const double awkward[] = {Limits::quiet_NaN(),
                              -Limits::quiet_NaN(),
                              Limits::infinity(),
                              -Limits::infinity(),
                              -0.0,
                              0.0,
                              Limits::denorm_min(),
                              Limits::max()};
    value = bits % 3 == 0 ? awkward[random() % std::size(awkward)] : std::bit_cast<double>(bits);
  } else if constexpr (std::is_same_v<T, bool>) {
    value = bits % 2 == 0;
  } else if constexpr (std::is_same_v<T, kernel::signal::ProgramState>) {
    value = static_cast<T>(bits % 4);
  } else if constexpr (std::is_same_v<T, kernel::signal::Motion>) {
    value = static_cast<T>(bits % 9);
  } else if constexpr (std::is_same_v<T, kernel::signal::Geometry>) {
    value = static_cast<T>(bits % 2);
  } else {
    value = static_cast<T>(bits);
  }
}

/// A sample with any value in every field; without a path.
inline Sample any_sample(Random& random) {
  Sample sample;
  sample_columns(sample, [&](const ColumnName&, auto& value) { randomize(random, value); });
  sample.path = 0;
  sample.original = 0;
  sample.vibrations = static_cast<std::uint32_t>(random() % (kMaxVibration + 1));
  for (double& reading : sample.vibration) {
    randomize(random, reading);
  }
  return sample;
}

inline kernel::signal::PathSegment any_segment(Random& random) {
  kernel::signal::PathSegment segment;
  segment_columns(segment, [&](const ColumnName&, auto& value) { randomize(random, value); });
  return segment;
}

/// The sample as the control cycle would hand it over.
inline void add(RecordWriter& writer, const Sample& sample,
                const kernel::signal::PathView& path = {},
                const kernel::signal::PathView& original = {}) {
  kernel::signal::Frame frame = sample.frame;
  frame.vibration = std::span(sample.vibration).first(sample.vibrations);
  frame.path = path;
  frame.original = original;
  writer.add(frame, sample.command);
}

/// All fields as bits; without number and path, which are the record's own.
inline std::vector<std::uint64_t> bits_of(Sample sample) {
  sample.number = 0;
  sample.path = 0;
  sample.original = 0;
  std::vector<std::uint64_t> bits;
  sample_columns(sample, [&](const ColumnName&, auto& value) { bits.push_back(to_bits(value)); });
  for (std::size_t i = 0; i < sample.vibrations; ++i) {
    bits.push_back(to_bits(sample.vibration[i]));
  }
  return bits;
}

inline std::vector<std::uint64_t> bits_of(const kernel::signal::PathView& path) {
  std::vector<std::uint64_t> bits;
  for (kernel::signal::PathSegment segment : path) {
    segment_columns(segment,
                    [&](const ColumnName&, auto& value) { bits.push_back(to_bits(value)); });
  }
  return bits;
}

/// A writer that writes when it is told to and at its end, at no other time.
inline std::unique_ptr<RecordWriter> quiet_writer(const std::string& file) {
  auto made = RecordWriter::make(
      {.file = file, .info = {.cycle_s = 0.001}, .commit_s = 3600.0, .drain_s = 3600.0});
  EXPECT_TRUE(made.has_value()) << kernel::outcome::text(made.error());
  return std::move(made.value());
}

}  // namespace steadyrest::record::test
