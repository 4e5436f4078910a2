// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// The calibration of an encoder as text: the keys phase_error_…, line_table_first,
/// line_table_periodic and line_table_… of [axis.encoder], alone or in a machine file.
namespace steadyrest::passport {

/// The keys with the values of `encoder`, one per line, the table in rows. Errors are rounded to
/// 1/100 000 of a count.
[[nodiscard]] std::string calibration_text(const kernel::machine::Encoder& encoder, bool rotary);

/// The machine file with these keys of the axis's [axis.encoder] replaced or added; every other
/// byte stays. Refused: a machine file that is faulty, has no such axis, has another count, or has
/// the encoder in a form without a definite place (inline table, dotted keys); and any result whose
/// other contents would differ.
[[nodiscard]] kernel::outcome::Result<std::string> with_calibration(
    std::string_view text, const std::string& file, std::string_view axis,
    const kernel::machine::Encoder& encoder);

/// Reads the keys alone, or those of `axis` from a whole machine file. `count_mm` is the length of
/// a count; a machine file must have the same.
[[nodiscard]] kernel::outcome::Result<kernel::machine::Encoder> read_calibration(
    const std::string& path, std::string_view axis, double count_mm);
[[nodiscard]] kernel::outcome::Result<kernel::machine::Encoder> parse_calibration(
    std::string_view text, const std::string& file, std::string_view axis, double count_mm);

}  // namespace steadyrest::passport
