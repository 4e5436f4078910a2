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

#include <steadyrest/nc/interpret/parameters/known_state.hpp>
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

  /// Where it is noted what the program reads that is not known; must outlive the object's use.
  void note_unknown(KnownState& known) noexcept { known_ = &known; }

  [[nodiscard]] read::Lookup number(int index, double& value) const override;
  [[nodiscard]] read::Lookup name(std::string_view name, double& value) const override;
  read::Lookup set_number(int index, double value) override;
  read::Lookup set_name(std::string_view name, double value) override;
  void commit() override;
  void drop() noexcept override;
  [[nodiscard]] bool take_unknown() const noexcept override {
    return known_ != nullptr && known_->take();
  }
  void sets_any() noexcept override { sets_any_ = true; }

  /// From here on the control decides its value: it may have been set, or not.
  void lose(int index);
  void lose(std::string_view name);
  void lose_all();

  /// #5061 … #5069 after a probing move: its end as programmed, mm and degrees.
  void record_probe(const Axes& end);
  /// #5399 after M66: what it was, 0 at first, and counts as unset.
  void record_input();
  void lose_input();
  /// A call with its arguments: #1 … are set to them, the rest of the thirty to zero.
  /// `unknown`: bit n: the control decides argument n.
  void enter(std::span<const double> arguments, std::uint32_t unknown = 0);
  /// A call that shares #1 … and the names with its caller (M98).
  void enter_shared();
  /// The end of a call; `returned` becomes #<_value>.
  void leave(const double* returned, bool unknown = false);
  /// Sets #<_value> and #<_value_returned>; nullptr: nothing was returned.
  void record_value(const double* returned, bool unknown = false) noexcept;
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
  struct Named {
    double value = 0.0;
    bool unknown = false;
    bool set = true;  ///< false: it may be set where the control decides otherwise
  };
  using Names = std::unordered_map<std::string, Named, Hash, std::equal_to<>>;
  template <class Key>
  struct Pending {
    Key key;
    double value = 0.0;
    bool unknown = false;
  };
  struct Call {
    std::array<double, kLocals> saved{};
    std::array<bool, kLocals> saved_set{};
    std::array<bool, kLocals> saved_unknown{};
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
  void assign(int index, double value, bool unknown);
  void ask(int index, double value) const;
  void ask(std::string_view name, double value) const;
  /// What was asked of the state to get the value; `given`: unknown all the same, but no
  /// assumption.
  template <class Name>
  void take(const Asked& asked, const Name& name, double value, bool given = false) const;
  void hear(std::string name, double value) const;
  read::Lookup read_named(const Named& named, double& value) const;
  [[nodiscard]] bool in_doubt() const noexcept { return known_ != nullptr && known_->doubt; }

  State* state_ = nullptr;
  const Config* config_ = nullptr;
  std::vector<double> numbers_;
  std::vector<bool> set_;      ///< by the program, or known from before
  std::vector<bool> unknown_;  ///< the value follows from one that the control decides
  bool value_unknown_ = false;
  bool sets_any_ = false;
  KnownState* known_ = nullptr;
  mutable Asked asked_;
  Names globals_;
  Names main_names_;
  std::vector<Call> calls_;
  double value_ = 0.0;
  double value_returned_ = 0.0;
  std::vector<Pending<int>> pending_numbers_;
  std::vector<Pending<std::string>> pending_names_;
};

}  // namespace steadyrest::nc::interpret
