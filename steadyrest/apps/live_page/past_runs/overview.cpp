// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <sys/stat.h>

#include <steadyrest/apps/live_page/past_runs/overview.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::apps::live_page::past_runs {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr float kNoValue = std::numeric_limits<float>::infinity();

Overview::Block block_at(double time_s) {
  Overview::Block block{.time = {.first_s = time_s, .last_s = time_s}};
  block.least.fill(kNoValue);
  block.most.fill(-kNoValue);
  return block;
}

void widen(Overview::Span& span, double time_s) {
  span.first_s = std::min(span.first_s, time_s);
  span.last_s = std::max(span.last_s, time_s);
}

void add_chunk(const CourseReader& reader, Overview& overview) {
  Overview::Span chunk{.first_s = reader.time_s(0), .last_s = reader.time_s(0)};
  for (std::size_t i = 0; i < reader.samples(); ++i) {
    const double time_s = reader.time_s(i);
    if (i % overview.block_samples == 0) {
      overview.blocks.push_back(block_at(time_s));
    }
    Overview::Block& block = overview.blocks.back();
    widen(block.time, time_s);
    widen(chunk, time_s);
    const CourseValues values = reader.values(i);
    for (std::size_t c = 0; c < values.size(); ++c) {
      block.least[c] = std::min(block.least[c], static_cast<float>(values[c]));
      block.most[c] = std::max(block.most[c], static_cast<float>(values[c]));
    }
  }
  overview.chunks.push_back(chunk);
}

void join_pairs(Overview& overview) {
  auto& blocks = overview.blocks;
  for (std::size_t i = 0; 2 * i < blocks.size(); ++i) {
    Overview::Block joined = blocks[2 * i];
    if (2 * i + 1 < blocks.size()) {
      const Overview::Block& second = blocks[2 * i + 1];
      widen(joined.time, second.time.first_s);
      widen(joined.time, second.time.last_s);
      for (std::size_t c = 0; c < joined.least.size(); ++c) {
        joined.least[c] = std::min(joined.least[c], second.least[c]);
        joined.most[c] = std::max(joined.most[c], second.most[c]);
      }
    }
    blocks[i] = joined;
  }
  blocks.resize((blocks.size() + 1) / 2);
  overview.block_samples *= 2;
}

/// Adds the chunks that are not in it yet.
Result<void> extend(const std::string& file, Overview& overview, const std::stop_token& stop) {
  auto reader = CourseReader::open(file);
  if (!reader) {
    return std::unexpected(std::move(reader.error()));
  }
  overview.cycle_s = reader->cycle_s();
  for (std::size_t chunk = overview.chunks.size(); chunk < reader->chunks(); ++chunk) {
    if (stop.stop_requested()) {
      return refuse("the page ends", "ask again when it runs");
    }
    if (auto read = reader->read(chunk); !read) {
      return read;
    }
    add_chunk(*reader, overview);
    if (overview.blocks.size() > Overview::kMostBlocks) {
      join_pairs(overview);
    }
  }
  return {};
}

std::uint64_t inode_of(const std::string& file) {
  struct stat status{};
  return ::stat(file.c_str(), &status) == 0 ? status.st_ino : 0;
}

}  // namespace

Result<std::shared_ptr<const Overview>> Overviews::of(const std::string& file,
                                                      const std::stop_token& stop) {
  const std::scoped_lock lock(mutex_);
  const std::uint64_t inode = inode_of(file);
  const auto known = std::ranges::find_if(
      known_, [&](const Known& at) { return at.file == file && at.inode == inode; });
  auto made = std::make_shared<Overview>(known == known_.end() ? Overview{} : *known->overview);
  if (auto extended = extend(file, *made, stop); !extended) {
    return std::unexpected(std::move(extended.error()));
  }
  std::erase_if(known_, [&](const Known& at) { return at.file == file; });
  known_.push_front({.file = file, .inode = inode, .overview = made});
  if (known_.size() > kMost) {
    known_.pop_back();
  }
  return made;
}

}  // namespace steadyrest::apps::live_page::past_runs
