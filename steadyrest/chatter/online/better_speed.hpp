// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <utility>
#include <vector>

#include <steadyrest/chatter/online/detector.hpp>
#include <steadyrest/chatter/online/line_evidence.hpp>
#include <steadyrest/chatter/online/speed_table.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/request.hpp>

namespace steadyrest::chatter::online {

/// Detects chatter and requests a better spindle speed: the planner's table answers the detector's
/// alarm with a request for the spindle override.
///
/// Law. When chatter begins, and again every `again_s` while it lasts, the table is queried from
/// the ratio in force; its answer is requested from then on. An answer stays after the chatter is
/// over, because the old speed would chatter again; it is dropped by `reset` or when the programmed
/// speed changes by more than 1 % (another cut). A step that leaves more than kFallen of the lines'
/// energy has not helped: where no other is better, it is taken back, and nothing is asked for
/// during ten times `again_s`. Where no step is better,
/// `reason` is chatter_no_better_speed. Without chatter or an answer the request is neutral.
///
/// Cost: Detector and SpeedTable::ask, one answer per sample, no allocation.
class BetterSpeed {
 public:
  struct Config {
    Detector::Config detector;
    SpeedTable::Config table;
    double again_s = 1.0;  ///< s, > 0; longer than the spindle needs to reach the new speed
    // NOLINTNEXTLINE(readability-redundant-member-init): designated initialisers may leave it out
    std::vector<double> modes_hz = {};  ///< of the process, to be named beside a line
  };

  struct Input {
    double value = 0.0;                                           ///< of the vibration, any unit
    double speed_rev_s = 0.0;                                     ///< of the spindle, now
    double angle_rev = std::numeric_limits<double>::quiet_NaN();  ///< as in Detector::Input
    double programmed_rev_s = 0.0;                                ///< at ratio 1
    double ratio = 1.0;     ///< of the spindle's override, in force
    double depth_mm = 0.0;  ///< of the cut; 0 = not known
  };

  struct Output {
    bool chatter = false;
    Detector::Kind kind = Detector::Kind::none;
    double frequency_hz = 0.0;
    double level = 0.0;        ///< the detector's energy ratio, 0 … 1
    double threshold = 0.0;    ///< the level above which a cut at constant speed surely chatters
    OrderGate::Output line;    ///< the strongest line and the order nearest to it
    double mode_hz = 0.0;      ///< the mode nearest to that; 0: none is known
    double confidence = 0.0;   ///< LineConfidence of this chatter; 0: there is none
    double speed_rev_s = 0.0;  ///< of the spindle, as its orders show it; 0: they do not
    double speed_sd = 0.0;     ///< the standard deviation of that, relative
    bool clips = false;        ///< the sensor's largest values are cut off
    kernel::signal::SpindleRequest request;
    kernel::outcome::Reason reason = kernel::outcome::Reason::none;  ///< the detector's, or that
                                                                     ///< of the last answer
  };

  struct State {
    Detector detector;  ///< a value: a copy continues as the original would
    double programmed_rev_s = 0.0;
    double since_asked = 0.0;  ///< samples
    double line_energy = 0.0;  ///< as the present step was asked for
    LineConfidence confidence;
    bool gave_up = false;  ///< a step was taken back
    kernel::outcome::Reason answer = kernel::outcome::Reason::none;
    Output out;
  };

  /// Refuses what Detector or SpeedTable refuse, and an again_s not above 0.
  [[nodiscard]] static kernel::outcome::Result<BetterSpeed> make(Config config);

  /// One sample.
  const Output& update(const Input& input) noexcept;
  void reset() noexcept;
  [[nodiscard]] const State& state() const noexcept { return state_; }
  /// From an object with the same detector setup.
  void restore(const State& state) noexcept { state_ = state; }
  /// Goes on where `before`, which has the same detector setup and must not run any more, is; the
  /// table stays its own. In the cycle: no allocation.
  void take_over(BetterSpeed& before) noexcept { std::swap(state_, before.state_); }

 private:
  BetterSpeed(Config config, Detector detector, SpeedTable table);
  void ask(const Input& input, double line_energy) noexcept;
  void show(const Detector::Output& heard) noexcept;

  double again_samples_;
  double threshold_;
  std::vector<double> modes_hz_;
  SpeedTable table_;
  State state_;
};

}  // namespace steadyrest::chatter::online
