// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::interpret {

/// Q0 … Q1999, QL0 … QL499 and QR0 … QR499 of `heidenhain`, by the numbers of klartext_value.hpp. Q
/// and QR are common to all programs; QL belong to the program that sets them. What the control
/// keeps in them, and what it writes there itself (Q100 … Q199), is not known: a parameter is unset
/// until the program sets it. A block's assignments take effect once it has been read.
class QParameters final : public read::Values {
 public:
  QParameters();

  [[nodiscard]] read::Lookup number(int index, double& value) const override;
  [[nodiscard]] read::Lookup name(std::string_view name, double& value) const override;
  read::Lookup set_number(int index, double value) override;
  read::Lookup set_name(std::string_view name, double value) override;
  void commit() override;
  void drop() noexcept override;

  /// Those that are set, with their values, as the program writes them.
  void list(std::vector<std::pair<std::string, double>>& out) const;
  /// How many programs are being called by CALL PGM: each has its own QL.
  void at_depth(std::size_t files);

 private:
  std::vector<double> common_;  ///< Q, then QR; NaN = unset
  std::vector<std::map<int, double>> local_;
  std::vector<std::pair<int, double>> pending_;
};

}  // namespace steadyrest::nc::interpret
