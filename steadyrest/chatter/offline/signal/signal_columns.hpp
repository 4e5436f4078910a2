// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/chatter/offline/signal/signal_names.hpp>
#include <steadyrest/chatter/offline/signal/signal_parts.hpp>
#include <steadyrest/table/clock.hpp>
#include <steadyrest/table/head.hpp>

/// The parts that the columns of a recording play. A column named `value` is the only signal; else
/// every named column that holds neither times nor the speed nor row numbers.
namespace steadyrest::chatter::offline {

struct SignalColumns {
  std::vector<ColumnName> name;     ///< of every column
  std::vector<std::size_t> signal;  ///< in the file's order
  std::optional<std::size_t> speed;
  double speed_rev_s = 1.0;  ///< per unit of that column
  std::optional<table::Clock> clock;
  std::string time = "t_s";  ///< the column of times, as written
  std::vector<std::string> notes;
};

/// Refused: no time, no signal, two speeds, a name twice that decides a part.
[[nodiscard]] OrFault<SignalColumns> columns_of(const table::Head& head,
                                                const table::Format& format);

}  // namespace steadyrest::chatter::offline
