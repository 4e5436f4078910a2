// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/passport/file/consistency.hpp>

/// The findings about the axes, part of those in consistency.hpp.
namespace steadyrest::passport {

/// Axes that contour together: present and linear. A rotary axis lags in degrees; its share of a
/// contour error depends on the radius, which no machine file knows.
[[nodiscard]] std::vector<const kernel::machine::Axis*> contouring(
    const kernel::machine::Machine& machine);

/// Servo gains, feed-forward, drives and the path's limits: how the axes follow the path.
void add_axis_findings(const kernel::machine::Machine& machine, std::vector<Finding>& out);

}  // namespace steadyrest::passport
