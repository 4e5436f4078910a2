// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <steadyrest/kernel/machine/compensation.hpp>

namespace steadyrest::nc::rewrite {

/// How a control takes a correction from its program. See README.md for the texts and the reasons:
/// haas has no P0, which would be G52 there; frame_fine adds to the value stored in $P_UIFR.
using Method = kernel::machine::CompensationMethod;

/// The method, never `by_dialect`, and what it must know about the machine.
struct Way {
  Method method = Method::linuxcnc;
  std::uint32_t r_parameter = 0;  ///< its number
  int sign = 1;  ///< setting_data: −1 where a positive value moves the axis to smaller positions
  bool external_offset_free = false;  ///< fanuc: 0 whenever a program starts
  /// Nobody touches off while a correction left by an aborted run is in force: it is cleared first.
  bool cleared_after_abort = false;
  std::string axes = "XYZ";    ///< linuxcnc: those of the machine
  double increment_mm = 1e-3;  ///< the control's least increment; a tenth of it in inches
};

/// The correction is in the active work offset: it must move along when another one is selected.
[[nodiscard]] constexpr bool in_work_offset(Method method) noexcept {
  return method == Method::linuxcnc || method == Method::haas || method == Method::frame_fine;
}
/// The machine adds the correction; the program's own positions exclude it.
[[nodiscard]] constexpr bool beside_program(Method method) noexcept {
  return method == Method::r_parameter || method == Method::setting_data;
}
/// In SINUMERIK's language: other comments.
[[nodiscard]] constexpr bool of_sinumerik(Method method) noexcept {
  return beside_program(method) || method == Method::frame_fine;
}

/// Written in mm whatever the program's unit.
[[nodiscard]] constexpr bool unit_free(Method method) noexcept {
  return method == Method::linuxcnc || beside_program(method);
}

/// A correction as it can be written: to 0.000001 mm on linuxcnc; else a whole number of the
/// control's least increments, 0.0001 inch for 0.001 mm (always mm outside the program's
/// coordinates). Sums are rounded, never steps, so that the written values add up.
[[nodiscard]] double writable_mm(const Way& way, double unit_mm, double correction_mm) noexcept;

/// A correction in mm as text: four digits after the point, up to six where they are not zero.
[[nodiscard]] std::string correction_number(double mm);

/// One change of an axis' correction.
struct Change {
  char letter = 'Z';
  double from_mm = 0.0;  ///< the present correction, writable
  double to_mm = 0.0;    ///< the new correction
  double unit_mm = 1.0;
  std::size_t active_offset = 0;
  bool incremental = false;  ///< G91 is in force at the place (only at a program's end)
};

/// The text of a change, each line with its tag and `ending`.
[[nodiscard]] std::string change_text(const Way& way, const Change& change,
                                      std::string_view ending);
/// Goes before and after a line in which the program sets an offset that holds a correction; empty
/// where nothing is noted about it.
[[nodiscard]] std::string check_text(const Way& way, char letter, std::string_view ending);
[[nodiscard]] std::string renote_text(const Way& way, char letter, std::string_view ending);
/// `G0 Z…` with its tag. Empty when the position cannot be written exactly.
[[nodiscard]] std::string restate_text(Method method, char letter, double position_mm,
                                       double unit_mm, std::string_view ending);
/// The text that restates the axis after a change: by its position where the program has set its
/// units, else in whatever units the control is in.
[[nodiscard]] std::string restate_text(Method method, const Change& change, bool units_said,
                                       double position_mm, std::string_view ending);
/// The head of a program that corrects these axes: takes off what an aborted run left, or stops.
[[nodiscard]] std::string head_text(const Way& way, std::string_view letters,
                                    std::string_view ending);

}  // namespace steadyrest::nc::rewrite
