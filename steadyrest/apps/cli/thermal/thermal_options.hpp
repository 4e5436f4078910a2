// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <steadyrest/apps/cli/shared/program_options.hpp>
#include <steadyrest/apps/cli/shared/session.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/thermal/offline/plan/cyclogram.hpp>
#include <steadyrest/thermal/online/thermal_model.hpp>

namespace steadyrest::apps::cli {

/// Options of `thermal forecast` and `thermal plan` about the machine and the work.
struct ThermalOptions {
  std::string machine;
  std::string cyclogram;
  ProgramOptions program;
  std::vector<std::string> axes;     ///< empty: all of the passport
  std::vector<std::string> ambient;  ///< SENSOR=°C
  std::string after;                 ///< cyclogram of the earlier work; empty: cold
};

void add_thermal_options(Verb& verb, ThermalOptions& options);

/// The same, read: the passport, the work, and for each axis the model in its starting state.
struct ThermalJob {
  struct Axis {
    thermal::online::ThermalModel model;
    std::vector<double> ambient_c;  ///< in the model's order; NaN: stays as it is
  };
  kernel::machine::Thermal passport;
  thermal::offline::Cyclogram cyclogram;
  std::vector<Axis> axis;
  std::vector<std::string> notes;  ///< what a reader of the forecast must know, one line each
};

/// Refused: what the files' readers refuse, an axis or a sensor that the passport lacks, a speed
/// far beyond the fitted ones, and neither or both of cyclogram and program.
[[nodiscard]] kernel::outcome::Result<ThermalJob> thermal_job(const ThermalOptions& options);

/// The job's notes, below the answer's text and as `notes`.
void put_notes(Answer& answer, const ThermalJob& job);

}  // namespace steadyrest::apps::cli
