// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <steadyrest/kernel/machine/unlimited.hpp>

namespace steadyrest::kernel::machine {

/// Friction of one axis as an acceleration (force over moved mass), Stribeck curve:
/// f(v) = sign(v)·(coulomb + (breakaway − coulomb)·exp(−(v/stribeck)²)) + viscous·v.
struct Friction {
  double coulomb_au_s2 = 0.0;
  double breakaway_au_s2 = 0.0;
  double stribeck_au_s = 1.0;
  double viscous_1_s = 0.0;

  friend bool operator==(const Friction&, const Friction&) = default;
};

struct Encoder {
  double count_au = 0.001;        ///< length of one count after ×4 decoding; 0 = ideal
  double line_error_au = 0.0;     ///< amplitude of the error that repeats with each line
  double line_period_au = 0.004;  ///< length of one line
  // The calibration, motion::online::LineTable: line k lies at k·count_au + phase_error_au[k mod 4]
  // + line_table_au[k − line_table_first].
  std::vector<double> phase_error_au;  ///< none or 4, their sum 0
  std::int64_t line_table_first = 0;   ///< line of the first entry
  bool line_table_periodic = false;    ///< the table is one revolution
  std::vector<double> line_table_au;   ///< 0 = line not known
  double clock_s = 1e-7;  ///< period of the edges' time stamps; 0 = the counter gives none

  friend bool operator==(const Encoder&, const Encoder&) = default;
};

/// One axis, linear or rotary. In its names, and in those of `Friction` and `Encoder`, `au` is the
/// axis unit: mm on a linear axis, rad on a rotary one. `max_speed_au_s` is in mm/s or rad/s.
struct Axis {
  std::string name = "X";  ///< X Y Z A B C U V W
  bool rotary = false;
  bool present = true;  ///< false: a placeholder for a missing X, Y or Z (a lathe's Y), so that the
                        ///< first three are X, Y, Z on every machine; its travel is 0…0
  double servo_gain_1_s = 50.0;    ///< position loop gain k
  double feed_forward = 0.0;       ///< weight a of the velocity feed-forward, 0…1
  double velocity_lag_s = 0.0;     ///< first-order lag of the closed velocity loop
  bool velocity_lag_known = true;  ///< false: the machine file does not say; the value is 0
  double max_speed_au_s = 200.0;
  double max_acceleration_au_s2 = 2000.0;
  double max_jerk_au_s3 = kUnlimited;
  double drive_acceleration_au_s2 =
      kUnlimited;  ///< what the drive can do at its current limit; the servo saturates there
  double backlash_au = 0.0;
  double min_au = -1e6;
  double max_au = 1e6;
  Friction friction;
  Encoder encoder;

  friend bool operator==(const Axis&, const Axis&) = default;
};

}  // namespace steadyrest::kernel::machine
