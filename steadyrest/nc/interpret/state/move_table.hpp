// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>

namespace steadyrest::nc::interpret {

/// `rapid`, `linear`, `arc`, `spline`, `probe`, `thread`, `dwell`.
[[nodiscard]] std::string_view name(MoveKind kind) noexcept;

/// Length of a move's path in mm; in degrees if only rotary axes move.
[[nodiscard]] double path_length(const Move& move) noexcept;

/// Path feed in mm/min (degrees/min if only rotary axes move) in any feed mode; 0 where there is
/// none or it is unknown (rapid, dwell, per revolution at constant cutting speed).
[[nodiscard]] double feed_mm_min(const Move& move) noexcept;

/// Writes moves as CSV, one row each, as they arrive: memory does not grow with the program.
///
/// Columns `line,kind,x_mm,y_mm,z_mm,a_deg,b_deg,c_deg,feed_mm_min,i_mm,j_mm,k_mm,turns`: end point
/// in the active work coordinates, arc centre in the same coordinates, turns > 0 counter-clockwise
/// seen against the plane's normal. Cells without meaning are empty. Shortest decimals that give
/// the same double back.
class MoveTable final : public Sink {
 public:
  static constexpr std::string_view kHead =
      "line,kind,x_mm,y_mm,z_mm,a_deg,b_deg,c_deg,feed_mm_min,i_mm,j_mm,k_mm,turns\n";

  /// Writes the header line. The caller keeps the file and commits it.
  explicit MoveTable(kernel::file::OutputFile& out);

  void on_move(const Move& move) override;
  void on_event(const Event& /*event*/) override {}
  /// Writes out whatever is still buffered.
  void finish();

 private:
  void number(double value);

  kernel::file::OutputFile& out_;
  std::string buffer_;
};

}  // namespace steadyrest::nc::interpret
