// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include <steadyrest/passport/file/contradictions.hpp>

// Contradictions between keys of one section. The schema checks the ranges of single keys; these
// functions see a section only when all its keys are good, and with the lines on which they were
// written.
namespace steadyrest::passport {
namespace {

using kernel::machine::Axis;
using kernel::machine::Chatter;
using kernel::machine::Compensation;
using kernel::machine::CompensationMethod;
using kernel::machine::Contour;
using kernel::machine::Control;
using kernel::machine::Encoder;
using kernel::machine::Envelope;
using kernel::machine::Friction;
using kernel::machine::Program;
using kernel::machine::Spindle;

/// A fault unless low ≤ high, shown in the file's own units. A default has no line, so the fault
/// points at the value that was written.
void ordered(const Given& given, Faults& faults, std::string_view low_key, double low,
             std::string_view high_key, double high) {
  if (low <= high) {
    return;
  }
  const Unit& low_unit = unit_of(low_key);
  const Unit& high_unit = unit_of(high_key);
  faults.add(
      given.has(low_key) ? given.at({low_key}) : given.at({high_key}),
      fmt::format("{} has {} = {} above {} = {}{}", given.section, low_key,
                  shown(low_unit.from_inner(low)), high_key, shown(high_unit.from_inner(high)),
                  given.has(low_key) && given.has(high_key) ? "" : " (one is the default)"),
      fmt::format("give {} no higher than {}", low_key, high_key));
}

/// An error of a whole count would put one line beyond its neighbour, and edges would change
/// places.
void below_a_count(const Encoder& encoder, std::span<const double> errors, const Given& given,
                   Faults& faults, std::string_view um, std::string_view deg) {
  const auto worst = std::ranges::find_if(
      errors, [&](double error) { return !(std::abs(error) < encoder.count_au); });
  if (worst != errors.end()) {
    const std::string_view key = given.has(um) ? um : deg;
    faults.add(given.at({key}),
               fmt::format("{} has the error {} {} in {}, one count or more", given.section,
                           shown(unit_of(key).from_inner(*worst)), unit_of(key).shown, key),
               "check the length of a count and calibrate again");
  }
}

/// Phase errors are the deviations of the four edges of a line from their mean, so they sum to 0; a
/// common part would be an offset of the scale.
void calibration(const Encoder& encoder, const Given& given, Faults& faults) {
  constexpr double kRounding = 1e-6;  // of a count
  const std::vector<double>& phase = encoder.phase_error_au;
  const double sum = std::accumulate(phase.begin(), phase.end(), 0.0);
  if (!phase.empty() && (phase.size() != 4 || std::abs(sum) > kRounding * encoder.count_au)) {
    faults.add(
        given.at({"phase_error_um", "phase_error_deg"}),
        phase.size() != 4
            ? fmt::format("{} has {} phase errors; 4 are needed", given.section, phase.size())
            : fmt::format("{} has phase errors whose sum is not 0", given.section),
        "give the four errors from `steadyrest motion calibrate`");
    return;
  }
  below_a_count(encoder, phase, given, faults, "phase_error_um", "phase_error_deg");
  below_a_count(encoder, encoder.line_table_au, given, faults, "line_table_um", "line_table_deg");
  // A quadrature encoder has four edges a line, so a revolution has a multiple of four.
  const std::size_t lines = encoder.line_table_au.size();
  if (encoder.line_table_periodic && (lines == 0 || lines % 4 != 0)) {
    faults.add(given.at({"line_table_periodic"}),
               fmt::format("{} has a periodic table of {} lines; a revolution has a multiple of 4",
                           given.section, lines),
               "give four times the encoder's lines per revolution");
  }
}

}  // namespace

/// Set-points come every whole number of servo periods; anything else would beat.
void contradictions(const Control& control, const Given& given, Faults& faults) {
  const double ratio = control.interpolator_period_s / control.servo_period_s;
  if (std::abs(ratio - std::round(ratio)) > 1e-9 || ratio < 1.0) {
    faults.add(
        given.at({"interpolator_period_ms", "servo_period_ms"}),
        fmt::format("{} has interpolator_period_ms = {} and servo_period_ms = {}: not a whole "
                    "multiple",
                    given.section, shown(control.interpolator_period_s * 1e3),
                    shown(control.servo_period_s * 1e3)),
        "give an interpolator period of 1, 2, 3 … servo periods");
  }
}

/// A letter of an axis that the control cannot wrap, a code that none is, half a position.
void contradictions(const Program& program, const Given& given, Faults& faults) {
  const auto letters = [&](std::string_view key, const std::string& value) {
    if (value.find_first_not_of("ABC") != std::string::npos) {
      faults.add(given.at({key}), fmt::format("{} has {} = \"{}\"", given.section, key, value),
                 "write letters of rotary axes: A, B, C");
    }
  };
  letters("wrapped_axes", program.wrapped_axes);
  letters("indexer_axes", program.indexer_axes);
  for (const auto& [key, size] :
       {std::pair{"tool_change_position_mm", program.tool_change_position_mm.size()},
        std::pair{"tool_change_rotary_deg", program.tool_change_rotary_rad.size()}}) {
    if (size != 0 && size != 3) {
      faults.add(given.at({key}),
                 fmt::format("{} has {} with {} numbers", given.section, key, size),
                 "give three: one for each axis");
    }
  }
  if (const std::string wrong = kernel::machine::odd_code(program.remapped); !wrong.empty()) {
    faults.add(given.at({"remapped"}),
               fmt::format("{} has remapped = \"{}\": {} is not a code", given.section,
                           program.remapped, wrong),
               "write codes as M6 G88.8 T S F, separated by blanks");
  }
}

/// Ends of travel that leave no travel.
void contradictions(const Axis& axis, const Given& given, Faults& faults) {
  const bool rotary = axis.rotary;
  if (axis.min_au >= axis.max_au) {
    const Unit& unit = unit_of(rotary ? "deg" : "mm");
    faults.add(given.at({"min_mm", "min_deg", "max_mm", "max_deg"}),
               fmt::format("{} has no travel: from {} to {} {}", given.section,
                           shown(unit.from_inner(axis.min_au)), shown(unit.from_inner(axis.max_au)),
                           unit.shown),
               "give a lower end below the upper end");
  }
}

/// ×4 decoding makes four counts of a line.
void contradictions(const Encoder& encoder, const Given& given, Faults& faults) {
  if (encoder.line_error_au > 0.0 && encoder.line_period_au < encoder.count_au) {
    faults.add(given.at({"line_period_um", "line_period_deg", "count_um", "count_deg"}),
               fmt::format("{} has a line shorter than one count", given.section),
               "a line is four counts long with ×4 decoding");
  }
  calibration(encoder, given, faults);
}

/// The Stribeck curve falls from breakaway to sliding friction; the other way round it would rise.
void contradictions(const Friction& friction, const Given& given, Faults& faults) {
  if (friction.breakaway_au_s2 < friction.coulomb_au_s2) {
    faults.add(given.at({"breakaway_mm_s2", "breakaway_deg_s2", "coulomb_mm_s2", "coulomb_deg_s2"}),
               fmt::format("{} has breakaway friction below its sliding friction", given.section),
               "give a breakaway value no lower than the coulomb value");
  }
}

/// The rated torque has no default; without it the largest torque applies, and there is nothing to
/// compare.
void contradictions(const Spindle& spindle, const Given& given, Faults& faults) {
  ordered(given, faults, "min_rpm", spindle.min_rev_s, "max_rpm", spindle.max_rev_s);
  if (given.has("rated_torque_n_m")) {
    ordered(given, faults, "rated_torque_n_m", spindle.rated_torque_n_m, "max_torque_n_m",
            spindle.max_torque_n_m);
  }
}

/// Target below limit, lowest feed below highest. With both weights 0 every feed would be equally
/// good.
void contradictions(const Contour& contour, const Given& given, Faults& faults) {
  ordered(given, faults, "target_um", contour.target_mm, "limit_um", contour.limit_mm);
  ordered(given, faults, "min_percent", contour.min_ratio, "max_percent", contour.max_ratio);
  if (contour.weight_contour + contour.weight_feed <= 0.0) {
    faults.add(given.at({"weight_contour", "weight_feed"}),
               fmt::format("{} has both weights 0", given.section),
               "give at least one weight above 0");
  }
}

/// The M words come in pairs; 0 for both means that the program has no say.
void contradictions(const Chatter& chatter, const Given& given, Faults& faults) {
  if (given.has("amplitude_percent") && chatter.amplitude_rev_s > 0.0) {
    faults.add(given.at({"amplitude_rpm"}),
               fmt::format("{} has the amplitude both in percent and in rev/min", given.section),
               "give amplitude_percent or amplitude_rpm, not both");
  }
  const bool is_on = chatter.m_code_on != 0;
  if (is_on != (chatter.m_code_off != 0) || (is_on && chatter.m_code_on == chatter.m_code_off)) {
    faults.add(given.at({"m_code_on", "m_code_off"}),
               fmt::format("{} has m_code_on = {} and m_code_off = {}", given.section,
                           chatter.m_code_on, chatter.m_code_off),
               "give two different M words, or 0 for both");
  }
}

/// Each method needs its own keys and none of the others': a key without effect here was meant for
/// another control, and the operator would trust it.
void contradictions(const Compensation& compensation, const Given& given, Faults& faults) {
  using Method = CompensationMethod;
  const Method method = compensation.method;
  const auto needs = [&](bool is_needed, std::string_view key, bool is_given) {
    if (is_needed != is_given) {
      faults.add(given.at({is_needed ? "method" : key}),
                 fmt::format("{} has method = \"{}\" {} {}", given.section, word(method),
                             is_needed ? "without" : "and", key),
                 is_needed ? fmt::format("add {} = …", key) : fmt::format("remove {}", key));
    }
  };
  needs(method == Method::r_parameter, "r_parameter", given.has("r_parameter"));
  // The sign is found on the machine with an indicator. There is no safe default: the wrong one
  // doubles the error.
  needs(method == Method::setting_data, "sign", given.has("sign"));
  if (given.has("sign") && compensation.sign == 0) {
    faults.add(given.at({"sign"}), fmt::format("{} has sign = 0", given.section),
               "write 1 or -1: the direction the axis moves when the setting data goes positive");
  }
  if (compensation.external_offset_free && method != Method::fanuc) {
    needs(false, "external_offset_free", true);
  }
  // cleared_after_abort refers to a store that only corrections use. Work offsets and frames are
  // also the operator's.
  const bool own_place = method == Method::r_parameter || method == Method::setting_data ||
                         (method == Method::fanuc && compensation.external_offset_free);
  if (compensation.cleared_after_abort && !own_place) {
    faults.add(
        given.at({"cleared_after_abort"}),
        fmt::format("{} has method = \"{}\" and cleared_after_abort", given.section, word(method)),
        method == Method::fanuc
            ? "remove it, or write external_offset_free = true if that is the case"
            : "remove it");
  }
  if (method == Method::linuxcnc) {
    needs(false, "least_increment_um", given.has("least_increment_um"));
  }
  // Least increments are decimal fractions of a millimetre (Fanuc IS-A 0.01, IS-B 0.001, IS-C
  // 0.0001 mm); whole multiples of 1e-5 mm cover them all.
  constexpr double kGrain_mm = 1e-5;
  constexpr double kRounding = 1e-6;
  const double grains = compensation.least_increment_mm / kGrain_mm;
  if (std::abs(grains - std::round(grains)) > kRounding) {
    faults.add(given.at({"least_increment_um"}),
               fmt::format("{} has least_increment_um = {:g}", given.section,
                           compensation.least_increment_mm * 1e3),
               "write a multiple of 0.01; it is 1 if the control's increment system is IS-B");
  }
}

/// The envelope's lower and upper limits.
void contradictions(const Envelope& envelope, const Given& given, Faults& faults) {
  ordered(given, faults, "min_feed_percent", envelope.min_feed_ratio, "max_feed_percent",
          envelope.max_feed_ratio);
  ordered(given, faults, "min_spindle_percent", envelope.min_spindle_ratio, "max_spindle_percent",
          envelope.max_spindle_ratio);
}

}  // namespace steadyrest::passport
