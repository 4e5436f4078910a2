// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace steadyrest::chatter::online {

/// What a cut has shown so far: it counts as normal for it.
///
/// Law. Energy of the lines: a mean of equal weight at first, then up over 0.5 s and down over 2 s,
/// of spectra that are not suspect. Free ratio: the largest, up over 0.13 s and down over 30 s,
/// from 0.5 s on, suspect or not: a stable cut may repeat any level that it has shown once.
class CutLevels {
 public:
  struct Seen {
    double line_energy = 0.0;  ///< of the lines that can be chatter
    double all_energy = 0.0;   ///< of all lines
    double free_ratio = 0.0;
    bool suspect = false;
  };
  void begin() noexcept { *this = CutLevels(); }
  /// A spectrum `hop_s` after the one before.
  void judge(double hop_s) noexcept { judged_s_ += hop_s; }
  void learn(const Seen& seen, double hop_s) noexcept;

  [[nodiscard]] double judged_s() const noexcept { return judged_s_; }
  [[nodiscard]] double line_energy() const noexcept { return line_energy_; }
  [[nodiscard]] double all_energy() const noexcept { return all_energy_; }
  [[nodiscard]] double free_ratio() const noexcept { return free_ratio_; }

 private:
  double judged_s_ = 0.0;
  double line_energy_ = 0.0;
  double all_energy_ = 0.0;
  double free_ratio_ = 0.0;
};

}  // namespace steadyrest::chatter::online
