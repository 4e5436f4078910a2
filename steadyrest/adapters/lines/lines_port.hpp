// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include <steadyrest/adapters/lines/lines_device.hpp>
#include <steadyrest/adapters/lines/spindle_watch.hpp>
#include <steadyrest/kernel/link/exchange.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/port/port.hpp>

namespace steadyrest::adapters::lines {

/// A machine whose override switch goes through the layer's lines.
///
/// read() is one reading of all lines, and of the encoders where there is a recorder: their clock
/// is the frames' then, else the computer's. The control shows no commanded positions: they are the
/// actual ones here, and what the axes' lag makes of them is found above
/// (live/path/commanded_port). write() leaves both words; they are on the wires before the next
/// reading.
class LinesPort final : public kernel::port::Port {
 public:
  /// `looks`: it writes nothing, whatever the wiring.
  enum class Use : std::uint8_t { acts, looks };

  /// Refused: no override is wired, a word whose steps cannot be walked.
  [[nodiscard]] static kernel::outcome::Result<std::unique_ptr<LinesPort>> make(
      const kernel::machine::Machine& machine, std::unique_ptr<Wires> wires,
      std::unique_ptr<EncoderSource> encoders, Use use = Use::acts);
  /// With what the machine file names.
  [[nodiscard]] static kernel::outcome::Result<std::unique_ptr<LinesPort>> open(
      const kernel::machine::Machine& machine, Use use = Use::acts);

  [[nodiscard]] kernel::port::Capability capability() const noexcept override;
  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override;
  kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override;

 private:
  LinesPort(const kernel::machine::Machine& machine, LinesDevice::Parts parts);
  void hide_axes(kernel::signal::Frame& frame) const noexcept;
  [[nodiscard]] double time_of(const LineSample& sample) noexcept;
  void show_axes(const EncoderReading& encoders, kernel::signal::Frame& frame) noexcept;
  void show_spindle(const EncoderReading& encoders, kernel::signal::Frame& frame) noexcept;
  void show_program(const LineSample& sample, kernel::signal::Frame& frame) const noexcept;
  [[nodiscard]] double position_mm(std::size_t axis, std::int64_t count) const noexcept;

  kernel::machine::Lines lines_;
  std::vector<kernel::machine::Axis> axes_;
  std::vector<std::int64_t> start_count_;  ///< of each axis
  double recorder_ahead_s_ = 0.0;          ///< its clock, of this computer's
  std::size_t encoders_;                   ///< that the recorder must have; 0: no recorder
  std::optional<SpindleWatch> spindle_watch_;
  std::uint64_t cycle_ = 0;
  kernel::signal::AxisValues before_mm_{};
  double before_s_ = 0.0;
  kernel::link::Exchange<LineSample, LineOrder> exchange_;  ///< last: its thread uses the device
};

}  // namespace steadyrest::adapters::lines
