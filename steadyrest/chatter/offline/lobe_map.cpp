// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <mutex>

#include <fmt/core.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <steadyrest/chatter/offline/depth_line.hpp>
#include <steadyrest/chatter/offline/limit_depth.hpp>
#include <steadyrest/chatter/offline/lobe_map.hpp>

namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

std::optional<Refusal> fault(const LobeMapConfig& config) {
  if (config.speed_rev_s.empty()) {
    return Refusal{Kind::bad_input, "", 0, "no speed", "give at least one speed"};
  }
  const std::vector<double>& depth = config.depth_mm;
  if (depth.empty() || !(depth.front() >= 0.0) || !(depth.back() > 0.0)) {
    return Refusal{Kind::bad_input, "", 0, "depths must start at 0 or above and reach above 0",
                   "give rising depths"};
  }
  for (std::size_t i = 1; i < depth.size(); ++i) {
    if (!(depth[i] > depth[i - 1])) {
      return Refusal{Kind::bad_input, "", 0,
                     fmt::format("depth {} mm after {} mm", depth[i], depth[i - 1]),
                     "give rising depths"};
    }
  }
  return std::nullopt;
}

/// One speed of the map.
void fill(DepthLine& line, std::size_t speed, LobeMap& map) {
  const std::size_t depths = map.depth_mm.size();
  for (std::size_t i = 0; i < depths; ++i) {
    map.log_radius[speed * depths + i] = line.log_radius(map.depth_mm[i]);
  }
  const double* const log_radius = &map.log_radius[speed * depths];
  double low = 0.0;
  double log_low = line.log_radius(0.0);
  for (std::size_t i = 0; i < depths; ++i) {
    if (log_radius[i] >= 0.0) {
      map.border_mm[speed] = line.crossing_mm(low, log_low, map.depth_mm[i], log_radius[i]);
      return;
    }
    if (i + 1 < depths && map.depth_mm[i] > low && log_radius[i] >= log_low &&
        log_radius[i] > log_radius[i + 1]) {
      const std::array depth{low, map.depth_mm[i], map.depth_mm[i + 1]};
      const auto island = island_mm(line, depth, {log_low, log_radius[i], log_radius[i + 1]});
      if (island) {
        map.border_mm[speed] = line.crossing_mm(low, log_low, *island, line.log_radius(*island));
        return;
      }
    }
    low = map.depth_mm[i];
    log_low = log_radius[i];
  }
}

}  // namespace

Result<LobeMap> lobe_map(const Process& process, const LobeMapConfig& config,
                         const std::function<void(double)>& progress) {
  if (const auto refused = fault(config)) {
    return std::unexpected(*refused);
  }
  const std::size_t speeds = config.speed_rev_s.size();
  LobeMap map{config.speed_rev_s, config.depth_mm,
              std::vector<double>(speeds * config.depth_mm.size()),
              std::vector<std::optional<double>>(speeds)};
  std::mutex mutex;
  std::optional<Refusal> refused;
  std::size_t done = 0;
  const auto one = [&](std::size_t speed) {
    auto line = DepthLine::make(process, config.speed_rev_s[speed], config.modulation,
                                config.depth_mm.back());
    if (line) {
      fill(*line, speed, map);
    }
    const std::scoped_lock lock(mutex);
    if (!line && !refused) {
      refused = line.error();
    }
    ++done;
    if (progress) {
      progress(static_cast<double>(done) / static_cast<double>(speeds));
    }
  };
  oneapi::tbb::task_arena arena(config.threads == 0 ? oneapi::tbb::task_arena::automatic
                                                    : static_cast<int>(config.threads));
  arena.execute([&] { oneapi::tbb::parallel_for(std::size_t{0}, speeds, one); });
  if (refused) {
    return std::unexpected(*refused);
  }
  return map;
}

}  // namespace steadyrest::chatter::offline
