// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/nc/interpret/control/stage.hpp>

namespace steadyrest::nc::interpret {

/// G10: work offsets (L2, L20) and the tool table (L1, L10, L11).
class OffsetData : private Stage {
 public:
  using Stage::Stage;

  bool set(const Step& step);

 private:
  bool work(const Step& step, double form);
  bool added_work(const Step& step, double form);
  bool tool(const Step& step, double form);
  bool set_tool_register(const Step& step, double form);
  bool set_more_offsets(const Step& step);
  void add_words(const Step& step, Axes& offset) const;
  /// Where the control now counts with another point, the next move begins where the machine is.
  void stand_at_machine(const Axes& machine);
  void place_here(const Step& step, double rotation_deg, Axes& offset) const;
  void place_tool(const Step& step, const Axes& machine, const Axes& frame, double turn_deg,
                  Tool& tool) const;
};

}  // namespace steadyrest::nc::interpret
