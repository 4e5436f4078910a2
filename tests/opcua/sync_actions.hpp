// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace steadyrest::opcua {

/// What a control has for its synchronized actions: R parameters by number, system variables by
/// name (`$AC_OVR`, `$AA_IM[X1]`).
class Variables {
 public:
  Variables() = default;
  Variables(const Variables&) = delete;
  Variables& operator=(const Variables&) = delete;
  virtual ~Variables() = default;

  /// Throws std::runtime_error where the control has none.
  virtual double& r(int number) = 0;
  virtual double read(const std::string& name) = 0;
  virtual void write(const std::string& name, double value) = 0;
};

/// Runs the very text that a control is given: static synchronized actions (IDS) with WHENEVER or
/// no condition, in the order of their numbers, once a cycle. Only what the text needs of the
/// language; anything else is refused when it is read.
class SyncActions {
 public:
  /// Throws std::runtime_error with the line that is not understood.
  explicit SyncActions(const std::string& text);

  /// The lines outside of the actions: assignments to R parameters.
  void start(Variables& of) const;
  void cycle(Variables& of) const;
  [[nodiscard]] std::size_t count() const noexcept { return actions_.size(); }

 private:
  using Value = std::function<double(Variables&)>;
  using Act = std::function<void(Variables&)>;
  struct Action {
    int number = 0;
    Value condition;  ///< empty: always
    std::vector<Act> acts;
  };
  friend class Parser;

  std::vector<Act> start_;
  std::vector<Action> actions_;
};

}  // namespace steadyrest::opcua
