// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <memory>

#include <steadyrest/contour/online/contour_error.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/trial/replay/derived_columns.hpp>

namespace steadyrest::trial::replay {

std::vector<record::Derived> derived_columns(const record::RunInfo& run) {
  using contour::online::ContourError;
  const auto machine = passport::parse(run.machine_text, "the record's machine file");
  if (!machine) {
    return {};
  }
  auto made = ContourError::make(contour::online::contour_config(machine->axes));
  if (!made) {
    return {};
  }
  auto error = std::make_shared<ContourError>(*made);
  return {{"contour_error_mm", [error](const record::Sample& sample) {
             // Against what the part should have, as the layer shows it.
             const ContourError::Output seen =
                 error->update(contour::online::original_input(sample.frame));
             return seen.valid && seen.in_cut && !sample.frame.original_unknown
                        ? seen.error_mm
                        : std::numeric_limits<double>::quiet_NaN();
           }}};
}

}  // namespace steadyrest::trial::replay
