// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <steadyrest/nc/interpret/parameters/known_state.hpp>
#include <steadyrest/nc/interpret/parameters/macro_arguments.hpp>
#include <steadyrest/nc/interpret/state/asked.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>
#include <steadyrest/nc/read/text/values.hpp>

namespace steadyrest::nc::interpret {

/// The variables of a FANUC custom macro: local #1 … #33, common #100 … #199 and #500 … #999, and
/// the system variables that follow from the program alone: #4001 … (modes), #5001 … (end of the
/// previous block, work coordinates), #5021 … (machine coordinates; not after G20, since their unit
/// is the machine's), #5041 … (work coordinates of the spindle nose).
///
/// At the start nothing is known of them, not even that they are vacant: the control may have kept
/// values. Certainly vacant are those that the program sets to #0, and the local ones that a macro
/// call (G65, G66) gives no value: each has its own #1 … #33, four deep. M98 shares its caller's.
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

  [[nodiscard]] Asked& asked() noexcept { return asked_; }
  [[nodiscard]] const Asked& asked() const noexcept { return asked_; }
  static constexpr std::size_t kDeepestMacro = 4;
  /// A macro call; its local variables. A modal one (G66) goes on with those that its last run has
  /// left.
  enum class Locals : std::uint8_t {
    shared,  ///< M98
    own,     ///< G65
    modal    ///< G66, whose arguments set_modal has
  };
  void enter(Locals kind, const MacroArguments& arguments);
  void leave();
  void set_modal(const MacroArguments& arguments) { modal_ = begun_with(arguments); }
  /// Whether a macro that is called again (L) begins as it did before: else what it begins with is
  /// not certain.
  [[nodiscard]] bool begins_alike() const;
  /// How many sets of local variables are in use beside the main program's.
  [[nodiscard]] std::size_t macros() const noexcept { return macros_; }
  /// From here on the control decides every value that is set.
  void lose_all();

  /// The set variables, `#500`, with their values.
  void list(std::vector<std::pair<std::string, double>>& out) const;

 private:
  static constexpr std::size_t kNumbers = 1000;
  [[nodiscard]] bool mode(int index, double& value) const;
  void hear(int index, double value) const;
  [[nodiscard]] bool position(int index, double& value) const;

  struct Variable {
    double value = 0.0;
    bool set = false;      ///< by the program; else the control may have kept a value
    bool unknown = false;  ///< follows from a value that the control decides
  };
  using LocalSet = std::array<Variable, MacroArguments::kLocals>;
  struct Level {
    Locals locals = Locals::shared;
    LocalSet callers;
    LocalSet begun;
  };
  [[nodiscard]] static LocalSet begun_with(const MacroArguments& arguments);
  [[nodiscard]] LocalSet locals() const;
  void put_locals(const LocalSet& locals);

  const State& state_;
  std::array<Variable, kNumbers> numbers_{};  ///< NaN: vacant
  std::vector<Level> levels_;
  LocalSet modal_{};
  std::size_t macros_ = 0;
  mutable Asked asked_;
  KnownState* known_ = nullptr;
  struct Pending {
    int index = 0;
    double value = 0.0;
    bool unknown = false;
  };
  std::vector<Pending> pending_;
};

}  // namespace steadyrest::nc::interpret
