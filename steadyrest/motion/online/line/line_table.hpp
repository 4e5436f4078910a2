// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/online/line/line_fit.hpp>

/// Where the encoder's lines really are, learnt from ordinary motion.
///
/// Position of line k = k·count + phase[k mod 4] + error[k]: the four edges of a period have the
/// same errors everywhere (duty cycle and quadrature), and single lines have their own. On a rotary
/// encoder the table repeats every revolution; on a scale it covers a range, outside which only the
/// phases are known.
namespace steadyrest::motion::online {

class LineTable {
 public:
  static constexpr std::size_t kMaxLines = 1U << 20;

  struct Config {
    double count_mm = 0.001;
    std::int64_t first_line = 0;  ///< where the table starts
    std::size_t lines = 0;        ///< its length, 0 … kMaxLines; 0 = only phases
    bool periodic = false;        ///< rotary: `lines` counts make a revolution
    double learn = 0.25;          ///< share of a residual that is learnt, 0 (fixed) … 1
    double max_span_s = 0.02;     ///< of a fit's window
    double max_rms_counts = 0.2;  ///< a worse fit teaches nothing
  };
  static kernel::outcome::Result<LineTable> make(const Config& config);

  /// Position of the line as far as known, mm. Errors below 0.003 counts RMS are no larger than
  /// those of the fits: then it is the nominal position.
  [[nodiscard]] double position_mm(std::int64_t line) const noexcept;

  /// For Edge::sigma_mm: how far the line may be off from that, 1σ; −1 while the table has no
  /// information. An unlearnt line is off as much as all lines were before.
  [[nodiscard]] float sigma_mm(std::int64_t line) const noexcept;

  /// Whether the line itself was learnt; of the others only the phases are known.
  [[nodiscard]] bool learnt(std::int64_t line) const noexcept;

  /// A passage: learns. In order of time; no allocation.
  void learn(double t_s, std::int64_t line, std::int8_t direction, bool lost) noexcept;

  /// Errors in mm as they are stored in the machine file.
  [[nodiscard]] const std::array<double, 4>& phase_mm() const noexcept { return phase_mm_; }
  [[nodiscard]] const std::vector<double>& error_mm() const noexcept { return error_mm_; }
  /// Lines whose stored error is 0 count as not learnt. Errors beyond the table's length are
  /// dropped.
  void restore(const std::array<double, 4>& phase_mm, std::span<const double> error_mm);
  /// Moves the common error of the learnt lines of a phase to the phase, so that lines never passed
  /// get it too. For the end of learning: it reads all lines.
  void settle() noexcept;

  /// Whether the table has enough information to be applied.
  [[nodiscard]] bool in_use() const noexcept { return worth_; }
  [[nodiscard]] const Config& config() const noexcept { return config_; }
  /// Fits that were good enough for learning.
  [[nodiscard]] std::uint64_t fits() const noexcept { return fits_; }
  /// Recent RMS of the fits' residuals, which the table does not explain, mm.
  [[nodiscard]] double residual_mm() const noexcept;

 private:
  explicit LineTable(const Config& config);
  void take(const LineFit::Residual& residual) noexcept;
  void weigh() noexcept;
  [[nodiscard]] double correction_mm(std::int64_t line) const noexcept;
  [[nodiscard]] std::ptrdiff_t index(std::int64_t line) const noexcept;

  Config config_;
  LineFit fit_;
  std::array<double, 4> phase_mm_{};
  std::vector<double> error_mm_;
  std::vector<std::uint8_t> visits_;
  double spread2_mm2_ = 0.0;  ///< of the single lines' errors, as learnt
  std::uint64_t fits_ = 0;
  bool worth_ = false;
  double residual2_mm2_ = 0.0;
};

}  // namespace steadyrest::motion::online
