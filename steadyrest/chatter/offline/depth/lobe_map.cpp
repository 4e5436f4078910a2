// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <mutex>
#include <optional>

#include <fmt/core.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <steadyrest/chatter/offline/depth/depth_line.hpp>
#include <steadyrest/chatter/offline/depth/lobe_map.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

constexpr std::size_t kMostMapPoints = 10'000'000;

std::optional<Refusal> fault(const LobeMapConfig& config) {
  if (config.speed_rev_s.empty()) {
    return bad_input("no speed", "give at least one speed");
  }
  const std::vector<double>& depth = config.depth_mm;
  if (config.speed_rev_s.size() > kMostMapPoints / std::max<std::size_t>(depth.size(), 1)) {
    return bad_input(fmt::format("a map of {} speeds × {} depths; allowed: {} points",
                                 config.speed_rev_s.size(), depth.size(), kMostMapPoints),
                     "give fewer steps; the border is refined between them");
  }
  if (depth.empty() || !(depth.front() >= 0.0) || !(depth.back() > 0.0)) {
    return bad_input("depths must start at 0 or above and end above 0", "give rising depths");
  }
  for (std::size_t i = 1; i < depth.size(); ++i) {
    if (!(depth[i] > depth[i - 1])) {
      return bad_input(fmt::format("depth {} mm after {} mm", depth[i], depth[i - 1]),
                       "give rising depths");
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
}

}  // namespace

Result<LobeMap> lobe_map(const Process& process, const LobeMapConfig& config,
                         const std::function<void(double)>& progress) {
  if (const auto refused = fault(config)) {
    return std::unexpected(*refused);
  }
  const std::size_t speeds = config.speed_rev_s.size();
  LobeMap map{config.speed_rev_s, config.depth_mm,
              std::vector<double>(speeds * config.depth_mm.size())};
  std::mutex mutex;
  std::optional<Refusal> refused;
  std::size_t done = 0;
  // One task is one speed with all its depths in rising order: the tracker continues from the
  // previous depth.
  const auto one = [&](std::size_t speed) {
    auto line = DepthLine::make(process, config.speed_rev_s[speed], config.modulation,
                                config.depth_mm.back());
    if (line) {
      fill(*line, speed, map);
    }
    // If one speed is refused, so is the map: a row of zeros would look like a border.
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
