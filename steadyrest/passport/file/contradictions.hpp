// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/passport/keys/section_reader.hpp>

/// Values of one section that are each allowed, but not together. Internal to the reader; anything
/// merely unwise is a finding (consistency.hpp), not a refusal.
namespace steadyrest::passport {

void contradictions(const kernel::machine::Control& control, const Given& given, Faults& faults);
void contradictions(const kernel::machine::Program& program, const Given& given, Faults& faults);
void contradictions(const kernel::machine::Axis& axis, const Given& given, Faults& faults);
void contradictions(const kernel::machine::Encoder& encoder, const Given& given, Faults& faults);
void contradictions(const kernel::machine::Friction& friction, const Given& given, Faults& faults);
void contradictions(const kernel::machine::Spindle& spindle, const Given& given, Faults& faults);
void contradictions(const kernel::machine::Contour& contour, const Given& given, Faults& faults);
void contradictions(const kernel::machine::Chatter& chatter, const Given& given, Faults& faults);
void contradictions(const kernel::machine::Compensation& compensation, const Given& given,
                    Faults& faults);
void contradictions(const kernel::machine::Envelope& envelope, const Given& given, Faults& faults);

}  // namespace steadyrest::passport
