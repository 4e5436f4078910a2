// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <steadyrest/passport/keys/schema.hpp>

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
      Key<Compensation>{
          "method", kMethod, 0, 0,
          "What is written: `linuxcnc` G10 L20 in the active work offset; `fanuc` G10 L2 P0, the "
          "external offset; `haas` G10 L2 P1 … P6, the active offset; `r_parameter` an R-parameter "
          "that the PLC takes over; `setting_data` $SA_TEMP_COMP_ABS_VALUE; `frame_fine` "
          "$P_IFRAME[axis,FI]. "
          "`by_dialect` is the method named like the dialect; sinumerik has none of that name."},
      Key<Compensation>{"r_parameter", &Compensation::r_parameter, 0, 32535,
                        "Number of the R-parameter. Must be given with that method."},
      Key<Compensation>{"sign", &Compensation::sign, -1, 1,
                        "What a positive value of the setting data does on this machine: 1 moves "
                        "the axis to larger positions, -1 to smaller ones. Try it with an "
                        "indicator. Must be given with `setting_data`; 0 is refused."},
      Key<Compensation>{"external_offset_free", &Compensation::external_offset_free, 0, 0,
                        "`fanuc`: nobody else uses the external offset, so it is 0 whenever a "
                        "program starts. The head of a program then sets it to 0, and so takes off "
                        "what an aborted run has left. A program that sets it itself, or names an "
                        "axis before it has said G90 or G91, is refused."},
      Key<Compensation>{"cleared_after_abort", &Compensation::cleared_after_abort, 0, 0,
                        "`r_parameter`, `setting_data`, and `fanuc` with `external_offset_free`: "
                        "when a program is aborted, the PLC or the operator takes the correction "
                        "off before anything is touched off. The head of a program then asks "
                        "nobody. Without it every program stops at its head (M0) and asks, since a "
                        "touch-off through what an aborted run has left shows in no number."},
      Key<Compensation>{"least_increment_um", &Compensation::least_increment_mm, 0.01, 10,
                        "fanuc, haas, sinumerik: the control's least input increment. Every "
                        "correction is a whole number of them; in programs in inches the increment "
                        "is 0.0001 inch where it is 1 um here. 1 is IS-B, 0.1 is IS-C. A multiple "
                        "of 0.01. linuxcnc has none."},
  };
  return kKeys;
}

Dialect dialect_of(CompensationMethod method, Dialect own) noexcept {
  switch (method) {
    case CompensationMethod::linuxcnc:
      return Dialect::linuxcnc;
    case CompensationMethod::fanuc:
    case CompensationMethod::haas:
      return Dialect::fanuc;
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
