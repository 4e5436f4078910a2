// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <steadyrest/nc/read/text/block.hpp>
#include <steadyrest/nc/read/text/typed_values.hpp>

namespace steadyrest::nc::interpret {

/// R0 … R999 and the variables that DEF and PROC define. R-parameters are common to all programs; a
/// variable belongs to the program or subprogram that defines it. The value that the control kept
/// in an R-parameter is unknown: it is unset until the program sets it. A block's assignments take
/// effect once it has been read; setting and using a value in one block is refused.
class SinumerikVariables final : public read::TypedValues {
 public:
  SinumerikVariables();

  [[nodiscard]] read::Lookup number(int index, double& value) const override;
  [[nodiscard]] read::Lookup name(std::string_view name, double& value) const override;
  read::Lookup set_number(int index, double value) override;
  read::Lookup set_name(std::string_view name, double value) override;
  void commit() override;
  void drop() noexcept override;
  bool define(std::string_view name, read::ValueType type, double value) override;
  bool define_argument(std::string_view name, read::ValueType type, std::size_t place,
                       double otherwise) override;

  /// The R-parameters that are set, `R5`, with their values, which the control keeps.
  void list(std::vector<std::pair<std::string, double>>& out) const;
  /// What the control holds in the R-parameters is not known from here on.
  void lose_all() noexcept;
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
    read::ValueType type;
    double value;
  };
  struct Frame {
    std::map<std::string, Variable, std::less<>> variables;
    read::Flow call;
    std::size_t taken = 0;
  };
  std::vector<double> numbers_;
  std::vector<Frame> frames_;
  std::vector<std::pair<int, double>> pending_numbers_;
  std::vector<std::pair<std::string, double>> pending_names_;
};

}  // namespace steadyrest::nc::interpret
