// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <steadyrest/passport/keys/schema.hpp>

// The method decides where the control stores a correction; nc/rewrite/README.md has the reasons
// for each.
namespace steadyrest::passport {
namespace {

using kernel::machine::Compensation;
using kernel::machine::CompensationMethod;
using kernel::machine::Dialect;

using std::string_view;

constexpr std::array<string_view, 7> kMethods = {"by_dialect",  "linuxcnc",     "fanuc",     "haas",
                                                 "r_parameter", "setting_data", "frame_fine"};
constexpr Choice<Compensation> kMethod = {
    kMethods,
    [](Compensation& section, std::size_t i) {
      section.method = static_cast<CompensationMethod>(i);
    },
    [](const Compensation& section) { return static_cast<std::size_t>(section.method); }};

}  // namespace

std::span<const Key<Compensation>> compensation_keys() noexcept {
  static const std::array kKeys = {
      Key<Compensation>{"method", kMethod, 0, 0,
                        "What is written: `linuxcnc` G10 L20 in the active work offset; `fanuc` "
                        "G10 L2 P0, the external offset; `haas` G10 L2 P1 … P6, the active offset; "
                        "`r_parameter` an R-parameter that the PLC picks up; `setting_data` "
                        "$SA_TEMP_COMP_ABS_VALUE; `frame_fine` $P_IFRAME[axis,FI]. `by_dialect` is "
                        "the method named after the dialect; sinumerik has none."},
      Key<Compensation>{"r_parameter", &Compensation::r_parameter, 0, 32535,
                        "Number of the R-parameter. Mandatory with that method."},
      Key<Compensation>{"sign", &Compensation::sign, -1, 1,
                        "The effect of a positive value of the setting data on this machine: 1 "
                        "moves the axis to larger positions, -1 to smaller ones. Try it with an "
                        "indicator. Mandatory with `setting_data`; 0 is refused."},
      // The external offset belongs to the operator unless the shop says otherwise; then it may be
      // set, and not only shifted.
      Key<Compensation>{"external_offset_free", &Compensation::external_offset_free, 0, 0,
                        "`fanuc`: nothing else uses the external offset, so it is 0 whenever a "
                        "program starts. The head of the program then sets it to 0, which removes "
                        "whatever an aborted run has left. A program is refused if it sets the "
                        "offset itself, or names an axis before G90 or G91."},
      // An aborted program leaves its last correction behind. Touching off on top of it would build
      // the error into the work offset.
      Key<Compensation>{"cleared_after_abort", &Compensation::cleared_after_abort, 0, 0,
                        "`r_parameter`, `setting_data`, and `fanuc` with `external_offset_free`: "
                        "after an aborted program the PLC or the operator removes the correction "
                        "before anyone touches off. The head of the program then does not ask. "
                        "Otherwise every program stops at its head (M0) and asks, because touching "
                        "off with a leftover correction leaves no trace in any number."},
      Key<Compensation>{
          "least_increment_um", &Compensation::least_increment_mm, 0.01, 10,
          "fanuc, haas, sinumerik: the control's least input increment. Every correction is a "
          "whole number of increments; in an inch program the increment is 0.0001 inch where it is "
          "1 um here. 1 is IS-B, 0.1 is IS-C. A multiple of 0.01. linuxcnc has none."},
  };
  return kKeys;
}

/// by_dialect suits any dialect of the file; the methods for SINUMERIK, Fanuc and Haas are tied to
/// theirs.
Dialect dialect_of(CompensationMethod method, Dialect own) noexcept {
  switch (method) {
    case CompensationMethod::linuxcnc:
      return Dialect::linuxcnc;
    case CompensationMethod::fanuc:
      return Dialect::fanuc;
    case CompensationMethod::haas:
      return own == Dialect::haas ? Dialect::haas : Dialect::fanuc;
    case CompensationMethod::r_parameter:
    case CompensationMethod::setting_data:
    case CompensationMethod::frame_fine:
      return Dialect::sinumerik;
    case CompensationMethod::by_dialect:
      break;
  }
  return own;
}

string_view word(CompensationMethod method) noexcept {
  const auto i = static_cast<std::size_t>(method);
  return i < kMethods.size() ? kMethods[i] : "?";
}

}  // namespace steadyrest::passport
