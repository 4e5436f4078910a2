// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/chatter/offline/process/speed_profile.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Options of the verbs that take a modulation of the spindle speed.
namespace steadyrest::apps::cli {

/// As given: in the literature's ratios or in the shop's terms.
struct LawOptions {
  std::string law;
  std::optional<double> rva;
  std::optional<double> rvf;
  std::optional<double> amplitude_rpm;
  std::optional<double> amplitude_percent;
  std::optional<double> period_s;
  std::uint64_t seed = 1;

  [[nodiscard]] bool modulated() const { return !law.empty() && law != "constant"; }
};

/// --law, --rva or --amplitude-rpm or --amplitude-percent, --rvf or --period-s, --seed.
void add_law_options(Verb& verb, LawOptions& options);

/// The modulation at this mean speed. An RVF whose law does not close with the tooth passes within
/// 64 periods is moved to the nearest one that does, by 0.5 % at most (more below 10 passes);
/// `wanted_rvf` is then the given one.
struct ChosenLaw {
  chatter::offline::Modulation modulation;
  std::optional<double> wanted_rvf;
};
[[nodiscard]] kernel::outcome::Result<ChosenLaw> chosen_law(
    const LawOptions& options, const chatter::offline::Process& process, double speed_rpm);

/// law, rva, rvf, amplitude_rpm and period_s unless the speed is 0, seed; `wanted_rvf` if it was
/// moved.
void put_law(Json& json, const ChosenLaw& chosen, double speed_rpm);
/// One line for people.
[[nodiscard]] std::string law_text(const ChosenLaw& chosen, double speed_rpm);

}  // namespace steadyrest::apps::cli
