// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include <steadyrest/passport/file/consistency.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

// The same for machine files; the findings must not fail on anything that loads.
namespace {

namespace passport = steadyrest::passport;
using namespace steadyrest::kernel;

void must(bool holds) {
  if (!holds) {
    std::abort();
  }
}

/// Whatever the reader accepts must be fit to build a machine from.
void must_be_fit(const machine::Machine& machine) {
  must(machine.axes.size() >= 3 && machine.axes.size() <= 8);
  must(machine.axes[0].name == "X" && machine.axes[1].name == "Y" && machine.axes[2].name == "Z");
  for (const machine::Axis& axis : machine.axes) {
    must(std::isfinite(axis.servo_gain_1_s) && axis.servo_gain_1_s > 0.0);
    must(axis.min_au <= axis.max_au);
  }
  for (const auto* table :
       {&machine.feed_override, &machine.rapid_override, &machine.spindle_override}) {
    must(!table->ratio.empty() && table->ratio.size() == table->code.size());
    for (const double ratio : table->ratio) {
      must(std::isfinite(ratio) && ratio >= 0.0);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto result = passport::parse_all_faults(text, "fuzz.toml");
  if (result) {
    must_be_fit(*result);
    static_cast<void>(passport::findings(*result));
  } else {
    must(!result.error().empty());
    for (const outcome::Refusal& refusal : result.error()) {
      must(!outcome::text(refusal).empty() && !refusal.to_do.empty());
    }
  }
  return 0;
}
