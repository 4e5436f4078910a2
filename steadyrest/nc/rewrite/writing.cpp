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
  return method == Method::linuxcnc            ? kLinuxcncPlaces
         : unit_mm == 1.0 || unit_free(method) ? kMmPlaces
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
std::string beside_change(const Way& way, const Change& change, std::string_view ending) {
  const auto text = [](double value) { return number(value + 0.0, kMmPlaces, kMmPlaces); };
  const std::string variable = way.method == Method::r_parameter
                                   ? fmt::format("R{}", way.r_parameter)
                                   : fmt::format("$SA_TEMP_COMP_ABS_VALUE[{}]", change.letter);
  const double value_mm =
      way.method == Method::r_parameter ? change.to_mm : way.sign * change.to_mm;
  return fmt::format("STOPRE ;STEADYREST {0}{1} mm{4}{2}={3} ;STEADYREST {0}{1} mm{4}",
                     change.letter, text(change.to_mm), variable, text(value_mm), ending);
}

// From what is stored, so that nothing adds up and the operator's own fine offset stays.
std::string fine_offset(char letter, double to_mm) {
  const std::string stored = fmt::format("$P_IFRAME[{0},FI]=$P_UIFR[$P_UIFRNUM,{0},FI]", letter);
  return to_mm == 0.0 ? stored
                      : fmt::format("{}{}{}", stored, to_mm < 0.0 ? "" : "+",
                                    number(to_mm, kMmPlaces, kMmPlaces));
}

}  // namespace

double writable_mm(Method method, double unit_mm, double correction_mm) noexcept {
  const int places = places_of(method, unit_mm);
  return unit_free(method) ? rounded(correction_mm, places)
                           : rounded(correction_mm / unit_mm, places) * unit_mm;
}

std::string change_text(const Way& way, const Change& change, std::string_view ending) {
  switch (way.method) {
    case Method::linuxcnc:
      return linuxcnc_change(change, ending);
    case Method::fanuc:
    case Method::haas:
      return fanuc_change(way.method, change, ending);
    case Method::r_parameter:
    case Method::setting_data:
      return beside_change(way, change, ending);
    case Method::frame_fine:
      break;
  }
  return fmt::format("{} ;STEADYREST {}{} mm{}", fine_offset(change.letter, change.to_mm),
                     change.letter, number(change.to_mm, kMmPlaces, kMmPlaces), ending);
}

std::string restate_text(Method method, char letter, double position_mm, double unit_mm,
                         std::string_view ending) {
  constexpr double kExact = 1e-10;
  const int places = unit_mm == 1.0 ? kMmPlaces : kInchPlaces;
  const double value = rounded(position_mm / unit_mm, places);
  if (std::abs(value * unit_mm - position_mm) > kExact) {
    return {};
  }
  return fmt::format("G0 {}{} {}{}", letter, number(value, places, places),
                     of_sinumerik(method) ? ";STEADYREST restated" : "(STEADYREST restated)",
                     ending);
}

// The global parameters live as long as LinuxCNC runs: after an abort they say what stands in the
// work offset. Stands it in another one than is active now, nobody but the operator can undo it.
std::string head_text(const Way& way, char letter, std::string_view ending) {
  switch (way.method) {
    case Method::r_parameter:  // these two keep their values over an abort and over power off
      return fmt::format("R{}=0.0000 ;STEADYREST head {}{}", way.r_parameter, letter, ending);
    case Method::setting_data:
      return fmt::format("$SA_TEMP_COMP_ABS_VALUE[{0}]=0.0000 ;STEADYREST head {0}{1}", letter,
                         ending);
    case Method::frame_fine:
      return fmt::format("{} ;STEADYREST head {}{}", fine_offset(letter, 0.0), letter, ending);
    case Method::fanuc:
      return way.external_offset_free
                 ? fmt::format("G90 G10 L2 P0 {0}0.0000 (STEADYREST head {0}){1}", letter, ending)
                 : std::string{};
    case Method::haas:
      return {};
    case Method::linuxcnc:
      break;
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
