// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <iterator>

#include <fmt/core.h>
#include <fmt/format.h>

#include <steadyrest/nc/rewrite/text/linuxcnc_text.hpp>
#include <steadyrest/nc/rewrite/text/writing.hpp>

namespace steadyrest::nc::rewrite {
namespace {

// Digits after the point: as many as each control accepts, and enough for the smallest increment a
// machine file may give.
constexpr int kLinuxcncPlaces = 6;
constexpr int kMmPlaces = 4;
constexpr int kInchPlaces = 5;
constexpr int kMostMmPlaces = 5;  ///< least increments are multiples of 0.00001 mm
constexpr int kMostInchPlaces = 6;

double rounded(double value, int places) noexcept {
  const double scale = std::pow(10.0, places);
  return std::round(value * scale) / scale + 0.0;  // no -0
}

/// At least four digits after the point (five in inches), more where they are not zero. A control
/// needs only the point, but four digits let micrometres be read at a glance.
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

std::string fanuc_change(Method method, const Change& change, std::string_view ending) {
  const bool mm = change.unit_mm == 1.0;
  // P0 is the external offset on Fanuc but G52 on Haas, where the active offset is set by number.
  // In G91, since the offset's value belongs to the operator.
  const std::size_t system = method == Method::fanuc ? 0 : change.active_offset + 1;
  const std::string mark = tag(change, mm ? kMostMmPlaces : kLinuxcncPlaces);
  std::string text =
      fmt::format("G91 G10 L2 P{} {}{} {}{}", system, change.letter,
                  number((change.to_mm - change.from_mm) / change.unit_mm,
                         mm ? kMostMmPlaces : kMostInchPlaces, mm ? kMmPlaces : kInchPlaces),
                  mark, ending);
  // Back to G90 only where the program is in it.
  if (!change.incremental) {
    fmt::format_to(std::back_inserter(text), "G90 {}{}", mark, ending);
  }
  return text;
}

// The control reads blocks ahead of the motion: STOPRE delays the write until the machine gets
// here.
std::string beside_change(const Way& way, const Change& change, std::string_view ending) {
  const auto text = [](double value) { return number(value + 0.0, kMostMmPlaces, kMmPlaces); };
  const std::string variable = way.method == Method::r_parameter
                                   ? fmt::format("R{}", way.r_parameter)
                                   : fmt::format("$SA_TEMP_COMP_ABS_VALUE[{}]", change.letter);
  // The manuals disagree on which way a positive temperature compensation moves the axis: the
  // machine file says what a dial indicator showed.
  const double value_mm =
      way.method == Method::r_parameter ? change.to_mm : way.sign * change.to_mm;
  return fmt::format("STOPRE ;STEADYREST {0}{1} mm{4}{2}={3} ;STEADYREST {0}{1} mm{4}",
                     change.letter, text(change.to_mm), variable, text(value_mm), ending);
}

// Relative to the stored value, so that nothing adds up and the operator's own fine offset stays.
std::string fine_offset(char letter, double to_mm) {
  const std::string stored = fmt::format("$P_IFRAME[{0},FI]=$P_UIFR[$P_UIFRNUM,{0},FI]", letter);
  return to_mm == 0.0 ? stored
                      : fmt::format("{}{}{}", stored, to_mm < 0.0 ? "" : "+",
                                    number(to_mm, kMostMmPlaces, kMmPlaces));
}

}  // namespace

std::string correction_number(double mm) {
  return number(mm, kLinuxcncPlaces, kMmPlaces);
}

double writable_mm(const Way& way, double unit_mm, double correction_mm) noexcept {
  if (way.method == Method::linuxcnc) {
    return rounded(correction_mm, kLinuxcncPlaces);
  }
  const bool inch = unit_mm != 1.0 && !unit_free(way.method);
  // 0.0001 inch where the metric increment is 0.001 mm. The sum is rounded, not each change, so
  // nothing drifts.
  const double increment_mm = way.increment_mm * (inch ? 0.1 * unit_mm : 1.0);
  return std::round(correction_mm / increment_mm) * increment_mm + 0.0;  // no -0
}

std::string change_text(const Way& way, const Change& change, std::string_view ending) {
  switch (way.method) {
    case Method::linuxcnc:
      return linuxcnc_change(way, change, ending);
    case Method::fanuc:
    case Method::haas:
      return fanuc_change(way.method, change, ending);
    case Method::r_parameter:
    case Method::setting_data:
      return beside_change(way, change, ending);
    case Method::frame_fine:
    case Method::by_dialect:  // never in a Way
      break;
  }
  return fmt::format("{} ;STEADYREST {}{} mm{}", fine_offset(change.letter, change.to_mm),
                     change.letter, number(change.to_mm, kMostMmPlaces, kMmPlaces), ending);
}

// G0 to where the axis is, in the coordinates that the correction has just shifted, so that the
// shift acts before the line.
std::string restate_text(Method method, char letter, double position_mm, double unit_mm,
                         std::string_view ending) {
  constexpr double kExact = 1e-10;
  const int places = unit_mm == 1.0 ? kMmPlaces : kInchPlaces;
  const double value = rounded(position_mm / unit_mm, places);
  // A position that the program's digits cannot express would move the axis, so this is not a
  // place.
  if (std::abs(value * unit_mm - position_mm) > kExact) {
    return {};
  }
  return fmt::format("G0 {}{} {}{}", letter, number(value, places, places),
                     of_sinumerik(method) ? ";STEADYREST restated" : "(STEADYREST restated)",
                     ending);
}

std::string restate_text(Method method, const Change& change, bool units_said, double position_mm,
                         std::string_view ending) {
  if (units_said) {
    return restate_text(method, change.letter, position_mm, change.unit_mm, ending);
  }
  // The unit is unknown here, so the position is not written out: the text takes the position shown
  // and removes what the change has just added.
  const double back_mm = change.to_mm - change.from_mm;
  const char axis = static_cast<char>(change.letter - 'A' + 'a');
  return fmt::format("G0 {}[#<_{}>{}{}*[#<_metric>+#<_imperial>/25.4]] (STEADYREST restated){}",
                     change.letter, axis, back_mm < 0.0 ? '-' : '+',
                     correction_number(std::abs(back_mm)), ending);
}

std::string check_text(const Way& way, char letter, std::string_view ending) {
  return way.method == Method::linuxcnc ? linuxcnc_check(way, letter, ending) : std::string{};
}

std::string renote_text(const Way& way, char letter, std::string_view ending) {
  return way.method == Method::linuxcnc ? linuxcnc_renote(way, letter, ending) : std::string{};
}

namespace {

/// No number shows whether somebody touched off through the correction left by an aborted run.
std::string question(const Way& way, std::string_view letters, std::string_view ending) {
  if (way.method == Method::fanuc) {
    return fmt::format(
        "M0 (STEADYREST head {}: IF TOUCHED OFF AFTER AN ABORTED RUN STOP, TOUCH OFF AGAIN "
        "WITH THE EXTERNAL OFFSET AT 0){}",
        letters, ending);
  }
  const std::string place = way.method == Method::r_parameter
                                ? fmt::format("R{}", way.r_parameter)
                                : std::string{"the temperature compensation"};
  return fmt::format(
      "MSG(\"{0}: touched off after an aborted run? Stop, set {1} to 0, touch off again\") "
      ";STEADYREST head {0}{2}M0 ;STEADYREST head {0}{2}MSG() ;STEADYREST head {0}{2}",
      letters, place, ending);
}

std::string axis_head(const Way& way, char letter, std::string_view ending) {
  switch (way.method) {
    case Method::r_parameter:  // these two keep their values through an abort and power off
      return fmt::format("R{}=0.0000 ;STEADYREST head {}{}", way.r_parameter, letter, ending);
    case Method::setting_data:
      return fmt::format("$SA_TEMP_COMP_ABS_VALUE[{0}]=0.0000 ;STEADYREST head {0}{1}", letter,
                         ending);
    case Method::frame_fine:
      return fmt::format("{} ;STEADYREST head {}{}", fine_offset(letter, 0.0), letter, ending);
    default:
      return fmt::format("G90 G10 L2 P0 {0}0.0000 (STEADYREST head {0}){1}", letter, ending);
  }
}

}  // namespace

std::string head_text(const Way& way, std::string_view letters, std::string_view ending) {
  if (letters.empty()) {
    return {};
  }
  if (way.method == Method::linuxcnc) {
    return linuxcnc_head(way, letters, ending);
  }
  const bool forgets =
      way.method == Method::haas || (way.method == Method::fanuc && !way.external_offset_free);
  if (forgets) {  // nothing tells it whether the last run was aborted
    return fmt::format(
        "M0 (STEADYREST head {}: AFTER AN ABORTED RUN TAKE OFF WHAT ITS LAST COMMENT NAMES){}",
        letters, ending);
  }
  std::string head;
  // frame_fine loads the stored frame: nothing to ask.
  if (way.method != Method::frame_fine && !way.cleared_after_abort) {
    head = question(way, letters, ending);
  }
  for (const char letter : letters) {
    head += axis_head(way, letter, ending);
  }
  return head;
}

}  // namespace steadyrest::nc::rewrite
