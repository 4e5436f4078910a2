// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace steadyrest::nc::rewrite {

/// How a control takes a correction from its program. README.md has the texts and the reasons.
enum class Method : std::uint8_t {
  linuxcnc,    ///< G10 L20 P0 in the active work offset
  fanuc,       ///< G91 G10 L2 P0: the external work offset
  haas,        ///< G91 G10 L2 P1 … P6: the active work offset; P0 would be G52 there
  r_parameter  ///< sinumerik: R<n>, which the PLC takes over
};

/// The correction stands in the active work offset: it must be moved when another one is chosen.
[[nodiscard]] constexpr bool in_work_offset(Method method) noexcept {
  return method == Method::linuxcnc || method == Method::haas;
}
/// The program's own positions do not know of the correction: the machine adds it.
[[nodiscard]] constexpr bool beside_program(Method method) noexcept {
  return method == Method::r_parameter;
}

/// Written in mm whatever the program's unit is.
[[nodiscard]] constexpr bool unit_free(Method method) noexcept {
  return method == Method::linuxcnc || method == Method::r_parameter;
}

/// A correction as it can be written: to 0.000001 mm on linuxcnc, else to 0.0001 mm, or in a
/// program in inches to 0.00001 inch (an R-parameter is always mm).
[[nodiscard]] double writable_mm(Method method, double unit_mm, double correction_mm) noexcept;

/// One change of what stands on one axis.
struct Change {
  char letter = 'Z';
  double from_mm = 0.0;  ///< the correction that stands, writable
  double to_mm = 0.0;    ///< the correction that will stand
  double unit_mm = 1.0;
  std::size_t active_offset = 0;
  std::uint32_t parameter = 0;  ///< number of the R-parameter
  bool incremental = false;     ///< G91 is in force at the place (only at a program's end)
};

/// The text of a change, each line with its tag and `ending`.
[[nodiscard]] std::string change_text(Method method, const Change& change, std::string_view ending);
/// `G0 Z…` with its tag. Empty when the position cannot be written exactly.
[[nodiscard]] std::string restate_text(char letter, double position_mm, double unit_mm,
                                       std::string_view ending);
/// What stands at the head of a program: takes off what an aborted run has left, or stops. Empty
/// where the control has nothing to remember it by.
[[nodiscard]] std::string head_text(Method method, char letter, std::uint32_t parameter,
                                    std::string_view ending);

}  // namespace steadyrest::nc::rewrite
