// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include <steadyrest/apps/page/chatter/chatter_page.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/trial/vibration/cut_simulation.hpp>

/// What the page of `chatter simulate` shows of a cut, collected step by step in bounded memory.
namespace steadyrest::apps::page {

class CutRecorder {
 public:
  /// `seconds` > 0 and `mean_rev_s` > 0 of the cut to come.
  CutRecorder(double seconds, double mean_rev_s);

  void add(const trial::vibration::Moment& now);

  /// x, y in µm and |F| in N: the extremes within even stretches of time, at most 3000. They show
  /// each vibration of a short cut and the size of a long one's.
  struct Envelope {
    std::vector<double> t_s;
    std::array<std::vector<double>, 3> low;
    std::array<std::vector<double>, 3> high;
  };
  /// One value per full turn of the spindle: x, y in µm. Beyond 4000 turns only every second, third
  /// … is kept.
  struct Turns {
    std::vector<double> t_s;
    std::array<std::vector<double>, 2> place_um;
  };

  [[nodiscard]] const Envelope& envelope() const noexcept { return envelope_; }
  [[nodiscard]] const Turns& turns() const noexcept { return turns_; }
  [[nodiscard]] std::size_t turns_between() const noexcept { return stride_; }
  /// The last steps: six turns, at most 8000 steps.
  [[nodiscard]] std::vector<trial::vibration::Moment> last() const;

 private:
  void widen(const trial::vibration::Moment& now);
  void turn(const trial::vibration::Moment& now);

  double stretch_s_;
  double last_stretch_;  ///< index of the last, which takes the rest of the time
  std::size_t stride_;
  double stretch_ = -1.0;
  double turned_ = 0.0;
  Envelope envelope_;
  Turns turns_;
  std::deque<trial::vibration::Moment> last_;
};

/// The page of `chatter simulate`.
[[nodiscard]] Json simulate_page(const Json& answer, const chatter::offline::Process& process,
                                 const CutRecorder& cut);

}  // namespace steadyrest::apps::page
