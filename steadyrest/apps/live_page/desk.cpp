// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <steadyrest/apps/live_page/desk.hpp>
#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::apps::live_page {

kernel::machine::Machine machine_in_force(const Desk& desk) {
  return desk.asked.reloader != nullptr ? desk.asked.reloader->running() : desk.machine;
}

Json rounded(double value, double to) {
  return std::isfinite(value) ? Json(std::round(value / to) * to) : Json();
}

Json micrometres(double mm) {
  return rounded(kernel::units::um_from_mm(mm), 1e-3);
}

Json switched_off_json(const steadyrest::live::LiveStatus& status) {
  constexpr auto kWhy = kernel::outcome::Reason::thermal_model_unfit;
  const bool off = status.heat_switched_off;
  return {{"switched_off", off},
          {"reason", off ? Json(kernel::outcome::name(kWhy)) : Json()},
          {"sentence", off ? Json(kernel::outcome::sentence(kWhy)) : Json()}};
}

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

web::Response answer(const Json& keys, unsigned status) {
  Json all = {{"version", steadyrest::live::kProtocol}};
  all.update(keys);
  web::Response out;
  out.status = status;
  out.body = text_of(all);
  return out;
}

}  // namespace steadyrest::apps::live_page
