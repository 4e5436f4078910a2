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

/// The parameters of a program: numbered (#1 … #5601), named local (#<a>) and global (#<_a>), and
/// what the interpreter itself answers for (#5061 … #5070, #5161 …, #5400 …, #<_x> …).
///
/// #1 … #30 and the local names belong to a call: enter() saves them, leave() brings them back.
/// The answers follow LinuxCNC 2.9 (rs274, by experiment): offsets, reference points and tool data
/// in the units of the machine's files (`Config::data_unit_mm`), positions in the units in force.
/// What only the running machine knows (#<_hal[…]>, #<_ini[…]>) is not answered. A probing move is
/// taken to end where it was programmed, and #5061 … say so.
class Parameters final : public read::Values {
 public:
  static constexpr int kNumbers = 5602;
  static constexpr std::size_t kLocals = 30;

  Parameters();

  /// Whose state is asked and set; both must stay where they are while it is used.
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
  /// The end of a call; `returned` what #<_value> is then.
  void leave(const double* returned);
  /// What #<_value> and #<_value_returned> are from now on; nullptr: nothing was returned.
  void record_value(const double* returned) noexcept;
  [[nodiscard]] std::size_t calls() const noexcept { return calls_.size(); }

  /// What the control has kept from before the program.
  void keep(std::span<const std::pair<int, double>> numbers);
  /// What the line in hand has asked of the control's own state; cleared by whoever reads lines.
  [[nodiscard]] Asked& asked() noexcept { return asked_; }
  [[nodiscard]] const Asked& asked() const noexcept { return asked_; }
  /// Numbers and global names that are set, `#100` and `#<_name>`, with their values: what the
  /// control keeps when the program is over.
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
  /// Where a stored offset or reference point lies in the state; nullptr when it is none of them.
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
