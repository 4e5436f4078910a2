// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/apps/live_page/desk.hpp>

namespace steadyrest::apps::live_page {

/// Of each axis the encoder, its calibration as the machine file in force has it, and what the
/// supervisor's motion stage makes of both. Lengths in µm, angles in degrees. A table of lines is
/// shown as the range of errors in at most 400 stretches.
[[nodiscard]] web::Response show_encoders(const Desk& desk);

/// One axis of it.
[[nodiscard]] Json encoder_json(const kernel::machine::Axis& axis, double cycle_s);

}  // namespace steadyrest::apps::live_page
