// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <vector>

#include <steadyrest/apps/live_page/past_runs/course_reader.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::apps::live_page::past_runs {

/// A record thinned: the least and the largest values of each short stretch, in 6 MB at most, and
/// the times of each chunk.
struct Overview {
  struct Span {
    double first_s = 0.0;
    double last_s = 0.0;
  };
  struct Block {
    Span time;
    std::array<float, kCourseNames.size()> least{};
    std::array<float, kCourseNames.size()> most{};
  };
  /// A record has at most this many blocks: with more, two become one.
  static constexpr std::size_t kMostBlocks = 65'536;

  std::vector<Block> blocks;
  std::vector<Span> chunks;
  std::size_t block_samples = 256;  ///< at most, in a block
  double cycle_s = 0.001;

  /// Of the first sample.
  [[nodiscard]] double first_s() const noexcept {
    return chunks.empty() ? 0.0 : chunks.front().first_s;
  }
  [[nodiscard]] double last_s() const noexcept {
    return chunks.empty() ? 0.0 : chunks.back().last_s;
  }
};

/// The overviews that were asked for last. From several threads.
class Overviews {
 public:
  /// Goes on from what is known of this file: a run that is being written only grows. Refuses a
  /// record that cannot be read, and what was stopped.
  [[nodiscard]] kernel::outcome::Result<std::shared_ptr<const Overview>> of(
      const std::string& file, const std::stop_token& stop);

 private:
  static constexpr std::size_t kMost = 4;
  struct Known {
    std::string file;
    std::uint64_t inode = 0;
    std::shared_ptr<const Overview> overview;
  };

  std::mutex mutex_;
  std::list<Known> known_;  ///< the last one first
};

}  // namespace steadyrest::apps::live_page::past_runs
