// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

namespace steadyrest::trial::batch {

/// The layer in act on the batch's machine: supervisor, arbiter and envelope as on a real one.
///
/// It gets frames every 2⁻ᵏ s, as rarely as `stale_after` permits: the envelope gives no credit for
/// longer gaps. Only the thermal room is on: the batch offers the others neither a path nor an
/// override's response.
class ActingLayer {
 public:
  /// One second of the machine as a frame shows it.
  struct Second {
    double speed_rev_s = 0.0;
    double feed_mm_s = 0.0;
    double cutting = 0.0;  ///< share of it with the tool in the cut
    bool coolant = false;
    double room_c = 20.0;
  };

  /// Refuses what the supervisor refuses.
  [[nodiscard]] static kernel::outcome::Result<ActingLayer> make(
      const kernel::machine::Machine& machine);

  /// The first frame; sets the workpiece's zero.
  void begin(double room_c) noexcept;
  /// The next second.
  void pass(const Second& second) noexcept;
  /// The probe finds the axis off by this much; one of the next frames carries it.
  void probe(std::size_t axis, double displacement_mm, double sd_mm);

  /// On the machine now.
  [[nodiscard]] double offset_mm(std::size_t axis) const noexcept { return offset_mm_[axis]; }

 private:
  ActingLayer(const kernel::machine::Machine& machine, supervisor::Supervisor layer);
  void show(const Second& second, bool cuts) noexcept;

  supervisor::Supervisor layer_;
  std::uint64_t frames_of_second_ = 16;
  std::size_t sensors_ = 0;
  kernel::signal::Frame frame_;
  std::vector<kernel::signal::ProbeReading> probed_;  ///< not yet carried by a frame
  kernel::signal::AxisValues offset_mm_{};
};

}  // namespace steadyrest::trial::batch
