// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <steadyrest/nc/interpret/parameters/known_state.hpp>
#include <steadyrest/nc/interpret/state/asked.hpp>
#include <steadyrest/nc/interpret/state/state.hpp>
#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/typed_values.hpp>

namespace steadyrest::nc::interpret {

/// R0 … R999 and the variables that DEF and PROC define. R-parameters are common to all programs; a
/// variable belongs to the program or subprogram that defines it. The value that the control kept
/// in an R-parameter is unknown: it is unset until the program sets it. A block's assignments take
/// effect once it has been read; setting and using a value in one block is refused.
///
/// System variables follow from the program where it has set what they show: $P_EP[X] (programmed
/// end position, not in inches), $P_F, $P_S, $P_UIFRNUM, $P_GG[1], $P_GG[6], $P_GG[14]. The control
/// decides all others of $P_…, $A…, $V…, $M…, $S…, $TC_…: they are taken as 0 and noted.
class SinumerikVariables final : public read::TypedValues {
 public:
  SinumerikVariables();

  /// The state that system variables show; outlives the object's use.
  void bind(const State& state) noexcept { state_ = &state; }
  /// Where it is noted what the program reads that is not known; must outlive the object's use.
  void note_unknown(KnownState& known) noexcept { known_ = &known; }
  [[nodiscard]] read::Lookup number(int index, double& value) const override;
  [[nodiscard]] read::Lookup name(std::string_view name, double& value) const override;
  read::Lookup set_number(int index, double value) override;
  read::Lookup set_name(std::string_view name, double value) override;
  void commit() override;
  void drop() noexcept override;
  bool define(std::string_view name, read::ValueType type, double value) override;
  bool define_argument(std::string_view name, read::ValueType type, std::size_t place,
                       double otherwise) override;
  void begin_call() override { passed_.clear(); }
  void pass(std::size_t place, std::string_view variable) override;
  bool define_reference(std::string_view name, read::ValueType type, std::size_t place) override;
  bool define_text(std::string_view name, std::string_view value) override;
  [[nodiscard]] const std::string* text(std::string_view name) const override;
  read::Lookup set_text(std::string_view name, std::string_view value) override;
  [[nodiscard]] read::Lookup system(std::string_view name, char axis, double& value) const override;
  [[nodiscard]] bool take_unknown() const noexcept override {
    return known_ != nullptr && known_->take();
  }
  /// From here on the control decides every value that is set.
  void lose_all();
  [[nodiscard]] Asked& asked() noexcept { return asked_; }
  [[nodiscard]] const Asked& asked() const noexcept { return asked_; }

  /// The R-parameters that are set, `R5`, with their values, which the control keeps.
  void list(std::vector<std::pair<std::string, double>>& out) const;
  /// A subprogram begins with the values of its call, starts over (P), ends.
  void enter(const read::Flow& call);
  void restart();
  void leave();
  /// The call has more values than the subprogram has taken.
  [[nodiscard]] bool values_left() const noexcept {
    return frames_.back().taken < frames_.back().call.count;
  }

 private:
  struct Variable {
    read::ValueType type = read::ValueType::real;
    double value = 0.0;
    bool unknown = false;  ///< follows from a value that the control decides
  };
  static constexpr std::size_t kMostVariables = 50'000;  ///< of one program, elements included
  struct Frame {
    std::map<std::string, Variable, std::less<>> variables;
    std::map<std::string, std::string, std::less<>> texts;
    read::Flow call;
    std::size_t taken = 0;
    std::map<std::size_t, std::string> passed;  ///< the caller's variables in the call, by place
    std::vector<std::pair<std::string, std::string>> references;  ///< VAR: own and caller's names
  };
  template <class Key>
  struct Pending {
    Key key;
    double value = 0.0;
    bool unknown = false;
  };
  void hear(bool unknown) const noexcept;
  void give_back();
  [[nodiscard]] bool in_doubt() const noexcept { return known_ != nullptr && known_->doubt; }
  [[nodiscard]] bool of_state(std::string_view name, char axis, double& value,
                              ModeMask& shown) const;

  const State* state_ = nullptr;
  KnownState* known_ = nullptr;
  mutable Asked asked_;
  std::vector<double> numbers_;
  std::vector<bool> unknown_;
  std::vector<Frame> frames_;
  std::map<std::size_t, std::string> passed_;
  std::vector<Pending<int>> pending_numbers_;
  std::vector<Pending<std::string>> pending_names_;
  std::vector<std::pair<std::string, std::string>> pending_texts_;
};

}  // namespace steadyrest::nc::interpret
