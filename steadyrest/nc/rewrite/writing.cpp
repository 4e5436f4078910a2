// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <iterator>

#include <fmt/core.h>
#include <fmt/format.h>

#include <steadyrest/nc/rewrite/writing.hpp>

namespace steadyrest::nc::rewrite {
namespace {

constexpr int kLinuxcncPlaces = 6;
constexpr int kMmPlaces = 4;
constexpr int kInchPlaces = 5;

char lower(char letter) noexcept {
  return static_cast<char>(letter - 'A' + 'a');
}

double rounded(double value, int places) noexcept {
  const double scale = std::pow(10.0, places);
  return std::round(value * scale) / scale + 0.0;  // no -0
}

int places_of(Method method, double unit_mm) noexcept {
  return method == Method::linuxcnc                        ? kLinuxcncPlaces
         : unit_mm == 1.0 || method == Method::r_parameter ? kMmPlaces
                                                           : kInchPlaces;
}

/// At least four digits behind the point (five in inches), more where they say something.
std::string number(double value, int places, int least) {
  std::string text = fmt::format("{:.{}f}", value, places);
  while (places > least && text.back() == '0') {
    text.pop_back();
    --places;
  }
  return text;
}

std::string tag(const Change& change, int places) {
  return fmt::format("(STEADYREST {}{} mm)", change.letter,
                     number(change.to_mm, places, kMmPlaces));
}

// mm in the text whatever G20/G21 say: LinuxCNC can divide, so nothing is rounded in inches.
std::string linuxcnc_change(const Change& change, std::string_view ending) {
  const double step_mm = change.from_mm - change.to_mm;
  const std::string amount = number(std::abs(step_mm), kLinuxcncPlaces, kMmPlaces);
  const char axis = lower(change.letter);
  return fmt::format(
      "G10 L20 P0 {}[#<_{}>{}{}{}] #<_steadyrest_{}>={} #<_steadyrest_system_{}>=#5220 {}{}",
      change.letter, axis, step_mm < 0.0 ? '-' : '+', amount, change.unit_mm == 1.0 ? "" : "/25.4",
      axis, number(change.to_mm, kLinuxcncPlaces, kMmPlaces), axis, tag(change, kLinuxcncPlaces),
      ending);
}

std::string fanuc_change(Method method, const Change& change, std::string_view ending) {
  const bool mm = change.unit_mm == 1.0;
  const int places = mm ? kMmPlaces : kInchPlaces;
  const std::size_t system = method == Method::fanuc ? 0 : change.active_offset + 1;
  const std::string mark = tag(change, mm ? kMmPlaces : kLinuxcncPlaces);
  std::string text = fmt::format(
      "G91 G10 L2 P{} {}{} {}{}", system, change.letter,
      number((change.to_mm - change.from_mm) / change.unit_mm, places, places), mark, ending);
  if (!change.incremental) {
    fmt::format_to(std::back_inserter(text), "G90 {}{}", mark, ending);
  }
  return text;
}

// The control reads blocks ahead of the motion: STOPRE makes it write the value when the machine
// gets here.
std::string parameter_change(const Change& change, std::string_view ending) {
  const std::string value = number(change.to_mm, kMmPlaces, kMmPlaces);
  return fmt::format("STOPRE ;STEADYREST {0}{1} mm{3}R{2}={1} ;STEADYREST {0}{1} mm{3}",
                     change.letter, value, change.parameter, ending);
}

}  // namespace

double writable_mm(Method method, double unit_mm, double correction_mm) noexcept {
  const int places = places_of(method, unit_mm);
  return unit_free(method) ? rounded(correction_mm, places)
                           : rounded(correction_mm / unit_mm, places) * unit_mm;
}

std::string change_text(Method method, const Change& change, std::string_view ending) {
  if (method == Method::r_parameter) {
    return parameter_change(change, ending);
  }
  return method == Method::linuxcnc ? linuxcnc_change(change, ending)
                                    : fanuc_change(method, change, ending);
}

std::string restate_text(char letter, double position_mm, double unit_mm, std::string_view ending) {
  constexpr double kExact = 1e-10;
  const int places = unit_mm == 1.0 ? kMmPlaces : kInchPlaces;
  const double value = rounded(position_mm / unit_mm, places);
  if (std::abs(value * unit_mm - position_mm) > kExact) {
    return {};
  }
  return fmt::format("G0 {}{} (STEADYREST restated){}", letter, number(value, places, places),
                     ending);
}

// The global parameters live as long as LinuxCNC runs: after an abort they say what stands in the
// work offset. Stands it in another one than is active now, nobody but the operator can undo it.
std::string head_text(Method method, char letter, std::uint32_t parameter,
                      std::string_view ending) {
  if (method == Method::r_parameter) {  // keeps its value over an abort and over power off
    return fmt::format("R{}=0.0000 ;STEADYREST head {}{}", parameter, letter, ending);
  }
  if (method != Method::linuxcnc) {
    return {};
  }
  const char axis = lower(letter);
  std::string text;
  const auto line = [&](const std::string& content) {
    fmt::format_to(std::back_inserter(text), "{} (STEADYREST head {}){}", content, letter, ending);
  };
  line(fmt::format("o<steadyrest_{}1> if [EXISTS[#<_steadyrest_{}>]]", axis, axis));
  line(fmt::format("o<steadyrest_{}2> if [#<_steadyrest_{}> NE 0]", axis, axis));
  line(fmt::format("o<steadyrest_{}3> if [#<_steadyrest_system_{}> NE #5220]", axis, axis));
  fmt::format_to(std::back_inserter(text),
                 "(ABORT,STEADYREST a correction of {} was left in work offset number "
                 "#<_steadyrest_system_{}>: #<_steadyrest_{}> mm; activate that offset first){}",
                 letter, axis, axis, ending);
  line(fmt::format("o<steadyrest_{}3> endif", axis));
  line(
      fmt::format("G10 L20 P0 {0}[#<_{1}>+#<_steadyrest_{1}>*[#<_metric>+#<_imperial>/25.4]] "
                  "#<_steadyrest_{1}>=0",
                  letter, axis));
  line(fmt::format("o<steadyrest_{}2> endif", axis));
  line(fmt::format("o<steadyrest_{}1> endif", axis));
  return text;
}

}  // namespace steadyrest::nc::rewrite
