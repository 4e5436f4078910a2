// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/adapters/lines/line_walk.hpp>

namespace steadyrest::adapters::lines {

using kernel::machine::Lines;
using kernel::machine::OverrideTable;
using kernel::machine::OverrideWires;
using kernel::outcome::Result;

Result<Walk> walk(Wires& wires, const Lines& lines, const OverrideWires& of,
                  const OverrideTable& table, const std::function<void()>& settle) {
  Walk seen;
  Levels inputs;
  Levels outputs;
  if (auto read = wires.read(inputs, outputs); !read) {
    return std::unexpected(std::move(read.error()));
  }
  for (const std::uint32_t mask : {lines.feed.mask, lines.spindle.mask}) {
    if (mask < kMostLines) {
      outputs.reset(mask);
    }
  }
  std::vector<std::uint32_t> codes = table.code;
  codes.push_back(table.code.front());
  for (const std::uint32_t code : codes) {
    put_word(code, of.out, of.out_inverted, outputs);
    if (auto written = wires.write(outputs); !written) {
      return std::unexpected(std::move(written.error()));
    }
    settle();
    Levels copy;
    if (auto read = wires.read(inputs, copy); !read) {
      return std::unexpected(std::move(read.error()));
    }
    seen.copy.push_back({.sent = code, .seen = word_of(copy, of.out, of.out_inverted)});
    seen.inputs.push_back({.sent = code, .seen = word_of(inputs, of.panel, of.panel_inverted)});
  }
  return seen;
}

void PanelWatch::see(std::uint32_t word) {
  const bool twice = started_ && word == last_;
  started_ = true;
  last_ = word;
  if (twice && (words_.empty() || words_[at_] != word)) {
    move_to(word);
  }
}

void PanelWatch::move_to(std::uint32_t word) {
  const auto known = std::ranges::find(words_, word);
  if (words_.empty()) {
    words_.push_back(word);
  } else if (at_ > 0 && words_[at_ - 1] == word) {
    --at_;
  } else if (at_ + 1 < words_.size() && words_[at_ + 1] == word) {
    ++at_;
  } else if (known != words_.end()) {
    ++out_of_order_;
    at_ = static_cast<std::size_t>(known - words_.begin());
  } else if (at_ == 0 && words_.size() > 1) {
    words_.insert(words_.begin(), word);
  } else {
    // What came after this position once is not its neighbour after all.
    out_of_order_ += at_ + 1 < words_.size() ? 1 : 0;
    words_.resize(++at_);
    words_.push_back(word);
  }
}

std::vector<std::uint32_t> PanelWatch::words() const {
  std::vector<std::uint32_t> ordered = words_;
  if (at_ == 0) {
    std::ranges::reverse(ordered);
  }
  return ordered;
}

bool PanelWatch::complete() const noexcept {
  return words_.size() == steps_ && (at_ == 0 || at_ + 1 == steps_);
}

std::vector<WordPair> paired(const OverrideTable& table, const std::vector<std::uint32_t>& words) {
  std::vector<WordPair> pairs;
  for (std::size_t i = 0; i < std::min(words.size(), table.code.size()); ++i) {
    pairs.push_back({.sent = table.code[i], .seen = words[i]});
  }
  return pairs;
}

std::vector<WireFault> stuck(const OverrideTable& table, const std::vector<std::uint32_t>& words,
                             std::size_t bits) {
  // Where two words differ.
  const auto changing = [](const std::vector<std::uint32_t>& of) {
    std::uint32_t bit_set = 0;
    for (const std::uint32_t word : of) {
      bit_set |= word ^ of.front();
    }
    return bit_set;
  };
  const std::uint32_t still = changing(table.code) & ~changing(words);
  std::vector<WireFault> faults;
  for (std::size_t bit = 0; bit < bits && words.size() > 1; ++bit) {
    if ((still >> bit & 1U) != 0) {
      const bool on = (words.front() >> bit & 1U) != 0;
      faults.push_back({.bit = bit,
                        .kind = on ? WireFault::Kind::stuck_on : WireFault::Kind::stuck_off,
                        .other = bit});
    }
  }
  return faults;
}

}  // namespace steadyrest::adapters::lines
