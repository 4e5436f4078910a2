// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include <steadyrest/adapters/linuxcnc/hal_side.hpp>
#include <steadyrest/adapters/linuxcnc/offset_course.hpp>
#include <steadyrest/adapters/linuxcnc/sample_queue.hpp>
#include <steadyrest/adapters/linuxcnc/translate.hpp>
#include <steadyrest/kernel/port/port.hpp>

namespace steadyrest::adapters::linuxcnc {

/// A running LinuxCNC as a machine.
///
/// read() hands out the servo cycles in order, each once, and waits for the next when there is
/// none: it sets the pace of the loop. age_s is the number of cycles that wait behind the frame
/// times the servo period. More than `most_waiting` are skipped to the newest. write() toggles the
/// heartbeat. When the watchdog in layer.hal has found the layer late (a pause of more than 20 ms),
/// the port arms it again.
class LinuxCncPort final : public kernel::port::Port {
 public:
  struct Config {
    Units units;
    bool spindle_connected = true;   ///< layer.hal's factor lies before the drive
    double lost_after_s = 0.1;       ///< without a sample: the link is lost; > servo period
    std::size_t most_waiting = 20;   ///< servo cycles
    double offset_slew_mm_s = 0.05;  ///< of the offset against heat, > 0; the envelope's
  };

  static kernel::outcome::Result<std::unique_ptr<LinuxCncPort>> make(const Config& config,
                                                                     HalSide& hal);

  [[nodiscard]] kernel::port::Capability capability() const noexcept override;
  kernel::outcome::Result<kernel::signal::Frame> read() noexcept override;
  kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override;

  /// The layer's pins are in force: armed and found alive. Of the thread that reads.
  [[nodiscard]] bool in_force() const noexcept { return sample_[Column::layer_alive] != 0.0; }

  // From any thread.
  /// Servo cycles that the sampler lost because its queue was full.
  [[nodiscard]] std::uint64_t missed() const noexcept { return queue_.missed(); }
  /// Servo cycles that were read too late to be handed out.
  [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_.load(); }
  /// How often the watchdog had to be armed after the first time.
  [[nodiscard]] std::uint64_t rearmed() const noexcept { return rearmed_.load(); }

 private:
  LinuxCncPort(const Config& config, HalSide& hal) noexcept
      : config_(config),
        hal_(hal),
        queue_(config.units.axes),
        heat_offset_(hal.offset_in_force()),
        course_({.acceleration = hal.offset_acceleration(),
                 .in_force = hal.offset_in_force(),
                 .slew = config.offset_slew_mm_s / config.units.linear_unit_mm,
                 .back = 1.0 / config.units.linear_unit_mm}),
        slowest_offset_mm_s2_(slowest_mm_s2(config.units, hal.offset_acceleration())),
        offsets_connected_(hal.offsets_connected()) {}
  [[nodiscard]] static double slowest_mm_s2(const Units& units,
                                            const kernel::signal::AxisValues& units_s2) noexcept;
  void arm() noexcept;
  [[nodiscard]] bool path_offset_gone() const noexcept;
  [[nodiscard]] bool feed_risen() const noexcept;
  void remember_offsets() noexcept;

  Config config_;
  HalSide& hal_;
  SampleQueue queue_;
  Sample sample_;
  /// Offsets in force as the last samples showed them, newest first.
  std::array<kernel::signal::AxisValues, 2> offsets_{};
  std::uint64_t offsets_tick_ = 0;
  kernel::signal::AxisValues heat_offset_;  ///< that the HAL has
  OffsetCourse course_;
  double slowest_offset_mm_s2_;
  bool offsets_connected_;
  Pins pins_;  ///< as asked for; the HAL gets the course's offsets
  std::atomic<std::uint64_t> skipped_{0};
  std::atomic<std::uint64_t> rearmed_{0};
  std::uint32_t beats_ = 0;  ///< since the watchdog was armed or released
};

}  // namespace steadyrest::adapters::linuxcnc
