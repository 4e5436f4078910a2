// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/apps/live_page/desk.hpp>

namespace steadyrest::apps::live_page {

kernel::machine::Machine machine_in_force(const Desk& desk) {
  return desk.asked.reloader != nullptr ? desk.asked.reloader->running() : desk.machine;
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
