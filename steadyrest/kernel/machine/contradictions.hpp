// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/machine/section_reader.hpp>

/// Values of one section that are each allowed, but not together. Internal to the reader; what is
/// merely unwise is a finding (consistency.hpp), not a refusal.
namespace steadyrest::kernel::machine {

void contradictions(const Control& control, const Given& given, Faults& faults);
void contradictions(const Axis& axis, const Given& given, Faults& faults);
void contradictions(const Encoder& encoder, const Given& given, Faults& faults);
void contradictions(const Friction& friction, const Given& given, Faults& faults);
void contradictions(const Spindle& spindle, const Given& given, Faults& faults);
void contradictions(const Contour& contour, const Given& given, Faults& faults);
void contradictions(const Chatter& chatter, const Given& given, Faults& faults);
void contradictions(const Compensation& compensation, const Given& given, Faults& faults);
void contradictions(const Envelope& envelope, const Given& given, Faults& faults);

}  // namespace steadyrest::kernel::machine
