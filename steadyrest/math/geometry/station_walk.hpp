// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::math::geometry {

/// The best walk through two rows of points in order; the law is that of path_pairing.hpp.
///
/// Dynamic programming within a band that follows the best partial walk: rows × band cells.
class StationWalk {
 public:
  struct Config {
    double tube_mm = 1.0;
    std::size_t half_band = 40;  ///< stations on either side of the best partial walk
  };
  /// The points of the second row that belong to one point of the first.
  struct Range {
    std::size_t first = 0;
    std::size_t last = 0;
  };
  /// If there is no walk: as far as one came.
  struct Stop {
    std::size_t changed = 0;   ///< the point that no walk reaches, or the last one
    std::size_t original = 0;  ///< where the best walk would have gone on
    bool at_end = false;  ///< every point of the first row was reached, not the end of the second
  };

  /// Neither row is empty.
  StationWalk(std::span<const kernel::signal::Point> changed,
              std::span<const kernel::signal::Point> original, const Config& config);

  [[nodiscard]] bool found() const noexcept { return found_; }
  /// If found: one for each point of the first row; together they cover the second.
  [[nodiscard]] std::vector<Range> ranges() const;
  /// If not found.
  [[nodiscard]] const Stop& stop() const noexcept { return stop_; }

 private:
  enum class From : std::uint8_t { nowhere, both, changed, original };
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  struct Row {
    std::size_t low = 0;   ///< first point of the second row in the band
    std::size_t high = 0;  ///< last
    std::size_t at = 0;    ///< where its cells begin in `from_`
  };
  /// Sums of squared distances along the best walk to each cell of a row.
  using Sums = std::vector<double>;

  [[nodiscard]] double cost(std::size_t i, std::size_t j) const noexcept;
  void begin(Row& row, Sums& sums);
  void advance(std::size_t i, const Row& above, const Sums& sums_above, Row& row, Sums& sums);

  std::span<const kernel::signal::Point> changed_;
  std::span<const kernel::signal::Point> original_;
  Config config_;
  std::vector<Row> rows_;
  std::vector<From> from_;
  std::size_t best_ = 0;  ///< of the present row; the second row's length if nothing is reached
  bool found_ = false;
  Stop stop_;
};

}  // namespace steadyrest::math::geometry
