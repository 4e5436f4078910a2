// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <steadyrest/nc/interpret/state/asked.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>
#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::interpret {

/// The parameters of a program: numbered (#1 … #5601), named local (#<depth>) and global
/// (#<_depth>), and those that the interpreter itself answers (#5061 … #5070, #5161 …, #5400 …,
/// #<_x> …).
///
/// #1 … #30 and the local names belong to a call: enter() saves them, leave() restores them. The
/// answers follow LinuxCNC 2.9 (rs274, by experiment): offsets, reference points and tool data in
/// the units of the machine's files (`Config::data_unit_mm`), positions in the units in force.
/// Values that only the running machine knows (#<_hal[…]>, #<_ini[…]>) are not answered. A probing
/// move is assumed to end where programmed, and #5061 … show that.
class Parameters final : public read::Values {
 public:
  static constexpr int kNumbers = 5602;
  static constexpr std::size_t kLocals = 30;

  Parameters();

  /// The state to read and set; both must outlive the object's use.
  void bind(State& state, const Config& config) noexcept {
    state_ = &state;
    config_ = &config;
  }

  [[nodiscard]] read::Lookup number(int index, double& value) const override;
  [[nodiscard]] read::Lookup name(std::string_view name, double& value) const override;
  read::Lookup set_number(int index, double value) override;
  read::Lookup set_name(std::string_view name, double value) override;
  void commit() override;
  void drop() noexcept override;

  /// #5061 … #5069 after a probing move: its end as programmed, mm and degrees.
  void record_probe(const Axes& end);
  /// A call with its arguments: #1 … are set to them, the rest of the thirty to zero.
  void enter(std::span<const double> arguments);
  /// A call that shares #1 … and the names with its caller (M98).
  void enter_shared();
  /// The end of a call; `returned` becomes #<_value>.
  void leave(const double* returned);
  /// Sets #<_value> and #<_value_returned>; nullptr: nothing was returned.
  void record_value(const double* returned) noexcept;
  [[nodiscard]] std::size_t calls() const noexcept { return calls_.size(); }

  /// The values that the control kept from before the program.
  void keep(std::span<const std::pair<int, double>> numbers);
  /// What the current line has read of the control's own state; whoever reads lines clears it.
  [[nodiscard]] Asked& asked() noexcept { return asked_; }
  [[nodiscard]] const Asked& asked() const noexcept { return asked_; }
  /// Numbers and global names that are set, `#100` and `#<_name>`, with their values: the control
  /// keeps these after the program.
  void list(std::vector<std::pair<std::string, double>>& out) const;

 private:
  struct Hash {
    using is_transparent = void;  // NOLINT(readability-identifier-naming): the library's name
    std::size_t operator()(std::string_view text) const noexcept {
      return std::hash<std::string_view>{}(text);
    }
  };
  using Names = std::unordered_map<std::string, double, Hash, std::equal_to<>>;
  struct Call {
    std::array<double, kLocals> saved{};
    std::array<bool, kLocals> saved_set{};
    Names names;
    bool shared = false;
  };
  [[nodiscard]] Names& local_names() noexcept;
  [[nodiscard]] const Names& local_names() const noexcept;

  [[nodiscard]] Axes position() const noexcept;
  [[nodiscard]] bool of_state(int index, double& value) const;
  [[nodiscard]] bool of_state(std::string_view name, double& value) const;
  /// The place of a stored offset or reference point in the state; nullptr for other numbers.
  [[nodiscard]] double* stored(int index, bool& rotary) const noexcept;
  void assign(int index, double value);
  void ask(int index) const;
  void ask(std::string_view name) const;

  State* state_ = nullptr;
  const Config* config_ = nullptr;
  std::vector<double> numbers_;
  std::vector<bool> set_;  ///< by the program, or known from before
  mutable Asked asked_;
  Names globals_;
  Names main_names_;
  std::vector<Call> calls_;
  double value_ = 0.0;
  double value_returned_ = 0.0;
  std::vector<std::pair<int, double>> pending_numbers_;
  std::vector<std::pair<std::string, double>> pending_names_;
};

}  // namespace steadyrest::nc::interpret
