// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/core.h>

#include <steadyrest/apps/cli/program/ahead/predicted_change.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::cli {

void put_prediction(Answer& answer, const contour::offline::PredictedChange& change,
                    double max_error_mm) {
  const auto& before = change.before.nominal();
  const auto& after = change.after.nominal();
  Json& json = answer.json;
  json["seconds_before"] = change.seconds_before;
  json["seconds_after"] = change.seconds_after;
  json["predicted_error_max_mm"] = after.max_mm;
  json["predicted_error_rms_mm"] = after.rms_mm();
  json["predicted_error_max_before_mm"] = before.max_mm;
  json["predicted_error_rms_before_mm"] = before.rms_mm();
  json["share_over_limit_before"] = change.before.share_over();
  json["share_over_limit"] = change.after.share_over();
  json["max_error_mm"] = max_error_mm;
}

Table prediction_table(const contour::offline::PredictedChange& change, double max_error_mm) {
  const auto seconds = [](double s) { return fmt::format("{:.2f} s", s); };
  const auto percent = [](double ratio) { return fmt::format("{:.2f} %", 100.0 * ratio); };
  const auto& before = change.before.nominal();
  const auto& after = change.after.nominal();
  Table table({"predicted", "before", "after"});
  table.row({"cycle time", seconds(change.seconds_before), seconds(change.seconds_after)})
      .row({"contour error, largest", in_um(before.max_mm), in_um(after.max_mm)})
      .row({"contour error, RMS", in_um(before.rms_mm()), in_um(after.rms_mm())})
      .row({fmt::format("over {} of the cut", in_um(max_error_mm)),
            percent(change.before.share_over()), percent(change.after.share_over())});
  return table;
}

void put_replaced(Answer& answer, const nc::rewrite::Replaced& changed) {
  answer.json["unchanged"] = changed.replaced == 0;
  answer.json["replaced_lines"] = changed.replaced;
  answer.json["new_lines"] = changed.new_lines;
}

std::string first_of(std::size_t count, const std::function<std::string(std::size_t)>& line) {
  constexpr std::size_t kShown = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(kShown, count); ++i) {
    text += line(i);
  }
  if (count > kShown) {
    text += fmt::format("… {} more lines (--json has them)\n", count - kShown);
  }
  return text;
}

std::string in_um(double mm) {
  return fmt::format("{:.1f} µm", kernel::units::um_from_mm(mm));
}

}  // namespace steadyrest::apps::cli
