// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include <steadyrest/kernel/port/port.hpp>
#include <steadyrest/record/record_reader.hpp>

namespace steadyrest::record {

/// A machine that repeats a recorded run: it shows the recorded frames whatever is written, and
/// fails to read and to write where the recorded one did. Reads a file, so it is not for the
/// control cycle.
class ReplayPort final : public kernel::port::Port {
 public:
  /// Refuses what RecordReader refuses.
  static kernel::outcome::Result<std::unique_ptr<ReplayPort>> open(const std::string& file);

  [[nodiscard]] kernel::port::Capability capability() const noexcept override;
  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override;
  kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override;

  /// The mode that was set, the machine file that took over, or the wish that was granted before
  /// the next read(); ask until there is none. The event lives in this port.
  [[nodiscard]] const Event* change_due();
  /// Nothing is left to read.
  [[nodiscard]] bool finished() const noexcept {
    return !more_ && event_ == reader_.events().size();
  }
  /// The number of the next frame's sample: it jumps where samples were lost.
  [[nodiscard]] std::optional<std::uint64_t> next_number() const noexcept {
    return more_ ? std::optional(samples_[1 - present_].number) : std::nullopt;
  }
  /// Why there is no more, if the record is damaged.
  [[nodiscard]] const std::optional<kernel::outcome::Refusal>& fault() const noexcept {
    return fault_;
  }
  /// The sample of the last frame.
  [[nodiscard]] const Sample& sample() const noexcept { return samples_[present_]; }
  [[nodiscard]] const RecordReader& reader() const noexcept { return reader_; }

 private:
  explicit ReplayPort(RecordReader reader) : reader_(std::move(reader)) { look_ahead(); }
  void look_ahead();
  /// The event that comes before the next frame; null if there is none.
  [[nodiscard]] const Event* due() const noexcept;

  RecordReader reader_;
  Sample samples_[2];  ///< the last and the next, in turn
  std::size_t present_ = 0;
  bool more_ = false;
  std::size_t event_ = 0;
  std::optional<kernel::outcome::Refusal> fault_;
};

}  // namespace steadyrest::record
