// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <steadyrest/chatter/online/detector.hpp>
#include <steadyrest/chatter/online/speed_table.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/request.hpp>

namespace steadyrest::chatter::online {

/// Hears chatter and asks for the better spindle speed: the detector's alarm, answered once by the
/// planner's table, as a request for the spindle's override.
///
/// Law. When chatter begins, and again each `again_s` while it lasts, the table is asked from the
/// ratio in force; what it answers is requested from then on. An answer stays when the chatter is
/// over, because the old speed would chatter again; it is dropped when the programmed speed changes
/// by more than 1 % (another cut) or by `reset`. Where no step is better, the request stays what it
/// was and `reason` says chatter_no_better_speed. Without chatter and answer the request is
/// neutral.
///
/// Bounds: those of Detector and SpeedTable::ask, one answer a sample, no allocation.
class BetterSpeed {
 public:
  struct Config {
    Detector::Config detector;
    SpeedTable::Config table;
    double again_s = 1.0;  ///< s, > 0; longer than the spindle needs to the new speed
  };

  struct Input {
    double value = 0.0;                                           ///< of the vibration, any unit
    double speed_rev_s = 0.0;                                     ///< of the spindle, now
    double angle_rev = std::numeric_limits<double>::quiet_NaN();  ///< as Detector::Input has it
    double programmed_rev_s = 0.0;                                ///< at ratio 1
    double ratio = 1.0;     ///< of the spindle's override, in force
    double depth_mm = 0.0;  ///< of the cut; 0 = not known
  };

  struct Output {
    bool chatter = false;
    Detector::Kind kind = Detector::Kind::none;
    double frequency_hz = 0.0;
    kernel::signal::SpindleRequest request;
    kernel::outcome::Reason reason = kernel::outcome::Reason::none;  ///< the detector's, or that
                                                                     ///< of the last answer
  };

  struct State {
    Detector detector;  ///< a value: its copy goes on as it would
    double programmed_rev_s = 0.0;
    double since_asked = 0.0;  ///< samples
    kernel::outcome::Reason answer = kernel::outcome::Reason::none;
    Output out;
  };

  /// Refuses what Detector or SpeedTable refuse, and an again_s that is not above 0.
  [[nodiscard]] static kernel::outcome::Result<BetterSpeed> make(Config config);

  /// One sample.
  const Output& update(const Input& input) noexcept;
  void reset() noexcept;
  [[nodiscard]] const State& state() const noexcept { return state_; }
  /// Of one that was made from the same detector's setup.
  void restore(const State& state) noexcept { state_ = state; }

 private:
  BetterSpeed(double again_samples, Detector detector, SpeedTable table);
  void ask(const Input& input) noexcept;

  double again_samples_;
  SpeedTable table_;
  State state_;
};

}  // namespace steadyrest::chatter::online
