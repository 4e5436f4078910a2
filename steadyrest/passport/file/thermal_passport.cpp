// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/passport/file/thermal_passport.hpp>
#include <steadyrest/passport/file/thermal_section.hpp>
#include <steadyrest/passport/text/text_check.hpp>
#include <steadyrest/passport/text/text_file.hpp>

// A passport comes alone, as `thermal fit` writes it, or as part of a machine file.
namespace steadyrest::passport {
namespace {

using kernel::machine::Thermal;

using kernel::outcome::refuse;
using kernel::outcome::Result;

/// True when the file has nothing but [thermal]; its sections are then read. Everything else goes
/// to the machine file's reader, which gives better messages.
bool passport_alone(std::string_view text, Thermal& thermal, Faults& faults) {
  try {
    const toml::table root = toml::parse(text);
    if (!std::all_of(root.begin(), root.end(),
                     [](const auto& entry) { return entry.first.str() == "thermal"; })) {
      return false;
    }
    read_thermal(root, thermal, faults);
    return true;
  } catch (const std::exception&) {
    return false;  // the machine file's reader says what is wrong
  }
}

}  // namespace

/// A thermal verb works on a passport without a machine, so a spindle test needs no complete
/// machine file.
Result<Thermal> parse_thermal_passport(std::string_view text, const std::string& file) {
  Thermal thermal;
  Faults faults{file, {}};
  if (unfit_text(text) || !passport_alone(text, thermal, faults)) {
    auto machine = parse(text, file);
    if (!machine) {
      return std::unexpected(machine.error());
    }
    thermal = std::move(machine->thermal);
  }
  if (!faults.list.empty()) {
    return std::unexpected(faults.list.front());
  }
  if (thermal.axis.empty()) {
    return refuse(file, "there is no [[thermal.axis]]",
                  "add the thermal passport: `steadyrest thermal fit` writes it");
  }
  return thermal;
}

Result<Thermal> read_thermal_passport(const std::string& path) {
  const auto text = read_text(path);
  if (!text) {
    return std::unexpected(text.error());
  }
  return parse_thermal_passport(*text, path);
}

}  // namespace steadyrest::passport
