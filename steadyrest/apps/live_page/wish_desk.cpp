// SPDX-License-Identifier: Apache-2.0
#include <variant>

#include <steadyrest/apps/live_page/wish_desk.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/live/wish/wish_json.hpp>
#include <steadyrest/web/gate.hpp>

namespace steadyrest::apps::live_page {
namespace {

web::Response refused(const kernel::outcome::Refusal& refusal) {
  return web::error(422, "refused", refusal.what, refusal.to_do);
}

}  // namespace

web::Response set_modulation(const Desk& desk, const Json& asked, const std::string& author) {
  const auto wish =
      steadyrest::live::modulation_wish(asked, machine_in_force(desk), "page: " + author);
  if (!wish) {
    return refused(wish.error());
  }
  if (const auto done = steadyrest::live::granted(desk.asked.loop.ask(*wish)); !done) {
    return refused(done.error());
  }
  return answer({{"modulation", steadyrest::live::modulation_json(
                                    std::get<chatter::online::Modulation>(wish->what))}});
}

web::Response enter_measured(const Desk& desk, HeatHistory& heat, const Json& asked,
                             const std::string& author) {
  const auto wish =
      steadyrest::live::measured_wish(asked, machine_in_force(desk), "page: " + author);
  if (!wish) {
    return refused(wish.error());
  }
  const auto done = steadyrest::live::granted(desk.asked.loop.ask(*wish));
  if (!done) {
    return refused(done.error());
  }
  const Json verdict = steadyrest::live::verdict_json(*done);
  Json reading = verdict;
  reading["axis"] = asked["axis"];
  reading["displacement_um"] = asked["displacement_um"];
  reading["author"] = author;
  heat.add_reading(std::move(reading));
  return answer({{"verdict", verdict}});
}

}  // namespace steadyrest::apps::live_page
