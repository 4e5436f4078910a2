// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include <steadyrest/apps/live_page/encoders.hpp>
#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/supervisor/motion_stage.hpp>

namespace steadyrest::apps::live_page {
namespace {

using kernel::machine::Axis;
using kernel::machine::Encoder;
using motion::online::LineTable;
using supervisor::MotionStage;

constexpr std::size_t kMostStretches = 400;
constexpr double kMillisecond_s = 1e-3;
constexpr double kNanosecond_s = 1e-9;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

/// The units of an axis, and its keys' endings.
class Unit {
 public:
  explicit Unit(bool rotary) noexcept : rotary_(rotary) {}
  /// Of encoder errors: µm, °.
  [[nodiscard]] Json small(double value_au) const {
    return number(rotary_ ? kernel::units::deg_from_rad(value_au)
                          : kernel::units::um_from_mm(value_au));
  }
  /// Of travel: mm, °.
  [[nodiscard]] Json length(double value_au) const {
    return number(rotary_ ? kernel::units::deg_from_rad(value_au) : value_au);
  }
  [[nodiscard]] std::string small_key(const std::string& name) const {
    return name + (rotary_ ? "_deg" : "_um");
  }
  [[nodiscard]] std::string key(const std::string& name, const std::string& per = "") const {
    return name + (rotary_ ? "_deg" : "_mm") + per;
  }

 private:
  bool rotary_;
};

/// A stretch's lowest and highest error, of the lines that are known there.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

Json curve_json(const LineTable& lines, const Unit& unit) {
  const LineTable::Config& table = lines.config();
  const std::size_t stretches = std::min(table.lines, kMostStretches);
  Json at = Json::array();
  Json low = Json::array();
  Json high = Json::array();
  for (std::size_t i = 0; i < stretches; ++i) {
    const std::size_t from = i * table.lines / stretches;
    const std::size_t to = (i + 1) * table.lines / stretches;
    Range range;
    for (std::size_t k = from; k < to; ++k) {
      const std::int64_t line = table.first_line + static_cast<std::int64_t>(k);
      if (lines.learnt(line)) {
        const double error =
            lines.error_mm()[k] + lines.phase_mm()[static_cast<std::size_t>(line & 3)];
        range.low = std::min(range.low, error);
        range.high = std::max(range.high, error);
      }
    }
    const double middle =
        static_cast<double>(table.first_line) + 0.5 * static_cast<double>(from + to - 1);
    at.push_back(unit.length(table.count_mm * middle));
    low.push_back(unit.small(range.low));
    high.push_back(unit.small(range.high));
  }
  return {{unit.key("at"), std::move(at)},
          {unit.small_key("low"), std::move(low)},
          {unit.small_key("high"), std::move(high)}};
}

Json calibration_json(const Encoder& encoder, const LineTable& lines, const Unit& unit) {
  if (encoder.phase_error_au.empty() && encoder.line_table_au.empty()) {
    return nullptr;
  }
  Json phases = Json::array();
  for (const double error : encoder.phase_error_au) {
    phases.push_back(unit.small(error));
  }
  const auto learnt =
      std::ranges::count_if(encoder.line_table_au, [](double e) { return e != 0.0; });
  return {{unit.small_key("phase_error"), std::move(phases)},
          {"lines", encoder.line_table_au.size()},
          {"lines_learnt", learnt},
          {"periodic", encoder.line_table_periodic},
          {"applied", lines.in_use()},
          {"curve", encoder.line_table_au.empty() ? Json() : curve_json(lines, unit)}};
}

/// `lag_ms` 0: the estimate is of the instant at which the cycle looked.
Json estimator_json(const MotionStage::Setup& setup, const Axis& axis, const Unit& unit) {
  const auto& limits = setup.limits;
  const bool stamps = axis.encoder.clock_s > 0.0 && axis.encoder.clock_s < limits.cycle_s;
  return {{"input", stamps ? "edges" : "counts"},
          {"cycle_ms", limits.cycle_s / kMillisecond_s},
          {"lag_ms", limits.lag_s / kMillisecond_s},
          {"bounded", limits.line_error_mm >= 0.0},
          {unit.small_key("line_error"),
           limits.line_error_mm < 0.0 ? Json() : unit.small(limits.line_error_mm)},
          {unit.key("max_speed", "_s"), unit.length(limits.max_speed_mm_s)},
          {unit.key("max_acceleration", "_s2"), unit.length(limits.max_acceleration_mm_s2)}};
}

}  // namespace

Json encoder_json(const Axis& axis, double cycle_s) {
  const Encoder& encoder = axis.encoder;
  const Unit unit(axis.rotary);
  const bool ideal = !(encoder.count_au > 0.0);
  Json out = {
      {"name", axis.name},
      {"rotary", axis.rotary},
      {"encoder",
       {{"ideal", ideal},
        {unit.small_key("count"), ideal ? Json() : unit.small(encoder.count_au)},
        {unit.small_key("line_period"), ideal ? Json() : unit.small(encoder.line_period_au)},
        {unit.small_key("line_error"), unit.small(encoder.line_error_au)},
        {"clock_ns", ideal || encoder.clock_s <= 0.0
                         ? Json()
                         : Json(std::round(encoder.clock_s / kNanosecond_s))}}},
      {"calibration", nullptr},
      {"estimator", nullptr}};
  const auto setup =
      ideal ? std::unexpected(kernel::outcome::Refusal()) : MotionStage::setup(axis, cycle_s);
  if (setup) {
    out["calibration"] = calibration_json(encoder, setup->lines, unit);
    out["estimator"] = estimator_json(*setup, axis, unit);
  }
  return out;
}

web::Response show_encoders(const Desk& desk) {
  const kernel::machine::Machine machine = machine_in_force(desk);
  Json axes = Json::array();
  for (const Axis& axis : machine.axes) {
    if (axis.present) {
      axes.push_back(encoder_json(axis, layer_cycle_s(machine)));
    }
  }
  return answer({{"motion", {{"axes", std::move(axes)}}}});
}

}  // namespace steadyrest::apps::live_page
