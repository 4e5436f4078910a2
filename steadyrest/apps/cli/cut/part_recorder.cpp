// SPDX-License-Identifier: Apache-2.0
#include <expected>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/apps/cli/cut/part_recorder.hpp>

namespace steadyrest::apps::cli::cut {

using kernel::outcome::Result;

void add_record_option(Verb& verb, std::string& file) {
  verb.writes(
      "--record", file,
      "Write the commanded and measured positions of the cut without the layer to this CSV, "
      "for `program predistort --from-record`",
      csv_content("a record of a part", {"t_s,x_cmd_mm"}));
}

Result<PartRecorder> PartRecorder::open(const std::string& file) {
  auto out = kernel::file::OutputFile::open(file);
  if (!out) {
    return std::unexpected(out.error());
  }
  out->write("t_s,x_cmd_mm,y_cmd_mm,z_cmd_mm,x_act_mm,y_act_mm,z_act_mm\n");
  return PartRecorder(std::move(*out));
}

void PartRecorder::add(const kernel::signal::Frame& frame) {
  const auto& [x, y, z] = std::tie(frame.axis[0], frame.axis[1], frame.axis[2]);
  out_.write(fmt::format("{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f}\n", frame.time_s,
                         x.command_mm, y.command_mm, z.command_mm, x.actual_mm, y.actual_mm,
                         z.actual_mm));
}

}  // namespace steadyrest::apps::cli::cut
