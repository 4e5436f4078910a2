// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <steadyrest/nc/interpret/parameters/known_state.hpp>
#include <steadyrest/nc/interpret/state/asked.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>
#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::interpret {

/// The variables of a FANUC custom macro: local #1 … #33, common #100 … #199 and #500 … #999, and
/// the system variables that follow from the program alone: #4001 … (modes), #5001 … (end of the
/// previous block, work coordinates), #5021 … (machine coordinates; not after G20, since their unit
/// is the machine's), #5041 … (work coordinates of the spindle nose).
///
/// All are vacant at the start: the values kept in #500 … are unknown. M98 leaves the local ones
/// unchanged.
class MacroVariables final : public read::Values {
 public:
  /// `state` outlives the object.
  explicit MacroVariables(const State& state);

  [[nodiscard]] read::Lookup number(int index, double& value) const override;
  [[nodiscard]] read::Lookup name(std::string_view name, double& value) const override;
  read::Lookup set_number(int index, double value) override;
  read::Lookup set_name(std::string_view name, double value) override;
  void commit() override;
  /// 0.001 mm, 0.0001 in, 0.001° (increment system IS-B).
  [[nodiscard]] double increment(char letter) const override;
  void drop() noexcept override;
  [[nodiscard]] bool take_unknown() const noexcept override {
    return known_ != nullptr && known_->take();
  }
  /// Where it is noted what the program reads that is not known; must outlive the object's use.
  void note_unknown(KnownState& known) noexcept { known_ = &known; }
  /// From here on the control decides the values: they may have been set, or not.
  void lose_all() noexcept { unknown_.fill(true); }

  [[nodiscard]] Asked& asked() noexcept { return asked_; }
  [[nodiscard]] const Asked& asked() const noexcept { return asked_; }
  /// The set variables, `#500`, with their values.
  void list(std::vector<std::pair<std::string, double>>& out) const;

 private:
  static constexpr std::size_t kNumbers = 1000;
  [[nodiscard]] bool mode(int index, double& value) const;
  void hear(int index, double value) const;
  [[nodiscard]] bool position(int index, double& value) const;

  const State& state_;
  std::array<double, kNumbers> numbers_{};
  mutable Asked asked_;
  KnownState* known_ = nullptr;
  std::array<bool, kNumbers> unknown_{};  ///< follows from a value that the control decides
  struct Pending {
    int index = 0;
    double value = 0.0;
    bool unknown = false;
  };
  std::vector<Pending> pending_;
};

}  // namespace steadyrest::nc::interpret
