// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/apps/cli/shared/log_options.hpp>
#include <steadyrest/apps/cli/shared/progress.hpp>
#include <steadyrest/contour/offline/identify/servo_fit.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::apps::cli {

struct RecordedServos {
  std::vector<contour::offline::ServoLog> logs;  ///< in the order of `places`
  std::string date;                              ///< of the run, UTC; empty: the file does not say
};

/// Whose log it is, and how it was written.
struct ServoSource {
  const kernel::machine::Machine& machine;
  const std::vector<std::size_t>& places;  ///< of the axes to read
  const LogOptions& options;
};

/// Commanded and actual positions of these axes. The form is recognised by the content, packed
/// with gzip or not:
///
///   SQLite   a record of `run --record`
///   {        a capture of SINUMERIK Edge (JSON)
///   <        a trace of SINUMERIK (XML)
///   else     a table: time_s, axis.command_mm.N, axis.actual_mm.N as `record export` writes it, or
///            a time and, for axis X, x_cmd_mm and x_act_mm or x_err_mm, the following error, in
///            mm, um, m, inch, deg or rad; --columns names them where the file does not
///
/// Axes of a capture or trace are the machine's by their names, else by their numbers, or as
/// --columns X=1,Y=2 says.
[[nodiscard]] kernel::outcome::Result<RecordedServos> read_servos(const std::string& file,
                                                                  const ServoSource& source,
                                                                  Progress& progress);

}  // namespace steadyrest::apps::cli
