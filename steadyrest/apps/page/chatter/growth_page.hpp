// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/page/chatter/chatter_page.hpp>
#include <steadyrest/chatter/offline/cycle/delay_cycle.hpp>
#include <steadyrest/chatter/offline/cycle/growth_course.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/chatter/offline/process/speed_profile.hpp>

namespace steadyrest::apps::page {

/// The page of `chatter radius`: how far a vibration grows over time, and the speed that causes it.
/// Times run from the beginning of the law's period; `worst` is the index of the course with the
/// greatest peak.
[[nodiscard]] Json growth_page(const Json& answer, const chatter::offline::Process& process,
                               const chatter::offline::DelayCycle& cycle,
                               const chatter::offline::SpeedProfile& speed,
                               const std::vector<chatter::offline::GrowthCourse>& courses);

}  // namespace steadyrest::apps::page
