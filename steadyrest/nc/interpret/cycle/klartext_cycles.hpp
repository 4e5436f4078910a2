// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <steadyrest/nc/interpret/control/stage.hpp>
#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::interpret {

/// Drilling cycles of `heidenhain`: CYCL DEF 200, 201, 203, 205, 206, 207, 240 and 1, in the
/// sequences of the manual "Cycle programming". Their values are read when they are called, from
/// the Q parameters that the definition sets: a parameter that is set directly after it counts, as
/// on the control.
///
/// Heights along the tool axis: surface s = Q203, clearance s + Q200, bottom s + Q201, second
/// clearance s + max(Q200, Q204). Feeds of 99999 and more are rapid.
class KlartextCycles : private Stage {
 public:
  using Stage::Stage;

  void bind(const read::Values& q) noexcept { q_ = &q; }

  /// A line of CYCL DEF: notes which cycle is in force, or acts where it acts at once.
  bool define(const Step& step);
  /// M99, M89, CYCL CALL.
  bool run(const Step& step);
  /// CYCL CALL POS: the tool must be above the clearance, since the order of its axes depends on
  /// it.
  bool check_position(const Step& step);
  /// A Q parameter that the definition must have set.
  bool value(const Step& step, int number, double& out);

 private:
  struct Hole;
  bool define_part(const Step& step);
  bool optional(int number, double& out) const;
  bool measure(const Step& step, Hole& hole);
  bool feed(const Step& step, int number, double& feed_mm_s);
  bool dwell(const Step& step, int number, double& seconds);
  void along(const Hole& hole, double feed_mm_s, double height);
  void rest(double seconds);
  void out_of_hole(const Hole& hole, double feed_mm_s);
  bool drill(const Step& step, Hole& hole);
  bool centre(const Step& step, Hole& hole);
  bool ream(const Step& step, Hole& hole);
  bool universal_drill(const Step& step, Hole& hole);
  bool universal_peck(const Step& step, Hole& hole);
  bool tap(const Step& step, Hole& hole);
  bool rigid_tap(const Step& step, Hole& hole);
  bool old_peck(const Step& step);
  bool count(const Step& step, double pecks);

  const read::Values* q_ = nullptr;
};

}  // namespace steadyrest::nc::interpret
