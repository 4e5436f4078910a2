// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <limits>

#include <steadyrest/nc/interpret/parameters/q_parameters.hpp>
#include <steadyrest/nc/read/heidenhain/klartext_value.hpp>

namespace steadyrest::nc::interpret {
namespace {

using read::Lookup;

constexpr int kCommonQ = 2000;
constexpr int kFewQ = 500;  ///< QL and QR

bool is_local_q(int index) noexcept {
  return index >= read::kFirstLocalQ && index < read::kFirstLocalQ + kFewQ;
}

/// Place among Q and QR; −1 for no such parameter.
int common_place(int index) noexcept {
  const int kept = index - read::kFirstKeptQ;
  return index >= 0 && index < kCommonQ ? index : kept >= 0 && kept < kFewQ ? kCommonQ + kept : -1;
}

}  // namespace

QParameters::QParameters()
    : common_(kCommonQ + kFewQ, std::numeric_limits<double>::quiet_NaN()), local_(1) {}

Lookup QParameters::number(int index, double& value) const {
  if (is_local_q(index)) {
    const auto found = local_.back().find(index);
    value = found == local_.back().end() ? 0.0 : found->second;
    return found == local_.back().end() ? Lookup::no_such_name : Lookup::found;
  }
  const int place = common_place(index);
  if (place < 0) {
    return Lookup::no_such_number;
  }
  value = common_[static_cast<std::size_t>(place)];
  return std::isnan(value) ? Lookup::no_such_name : Lookup::found;
}

Lookup QParameters::name(std::string_view /*name*/, double& /*value*/) const {
  return Lookup::no_such_name;
}

Lookup QParameters::set_number(int index, double value) {
  if (!is_local_q(index) && common_place(index) < 0) {
    return Lookup::no_such_number;
  }
  pending_.emplace_back(index, value);
  return Lookup::found;
}

Lookup QParameters::set_name(std::string_view /*name*/, double /*value*/) {
  return Lookup::no_such_name;
}

void QParameters::commit() {
  for (const auto& [index, value] : pending_) {
    if (is_local_q(index)) {
      local_.back()[index] = value;
    } else {
      common_[static_cast<std::size_t>(common_place(index))] = value;
    }
  }
  drop();
}

void QParameters::drop() noexcept {
  pending_.clear();
}

void QParameters::list(std::vector<std::pair<std::string, double>>& out) const {
  for (int i = 0; i < kCommonQ + kFewQ; ++i) {
    const double value = common_[static_cast<std::size_t>(i)];
    if (!std::isnan(value)) {
      out.emplace_back(i < kCommonQ ? "Q" + std::to_string(i) : "QR" + std::to_string(i - kCommonQ),
                       value);
    }
  }
}

void QParameters::at_depth(std::size_t files) {
  local_.resize(files + 1);
}

}  // namespace steadyrest::nc::interpret
