// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/chatter_page/chatter_page.hpp>
#include <steadyrest/chatter/offline/delay_cycle.hpp>
#include <steadyrest/chatter/offline/growth_course.hpp>
#include <steadyrest/chatter/offline/process.hpp>
#include <steadyrest/chatter/offline/speed_profile.hpp>

namespace steadyrest::apps::chatter_page {

/// The page of `chatter radius`: how far a vibration grows on its way, over time, and the speed
/// that makes it. Times run from the beginning of the law's period; `worst` is the index of the
/// course with the greatest peak.
[[nodiscard]] Json growth_page(const Json& answer, const chatter::offline::Process& process,
                               const chatter::offline::DelayCycle& cycle,
                               const chatter::offline::SpeedProfile& speed,
                               const std::vector<chatter::offline::GrowthCourse>& courses);

}  // namespace steadyrest::apps::chatter_page
