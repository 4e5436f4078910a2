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
  if (twice && (words_.empty() || words_.back() != word)) {
    words_.push_back(word);
  }
}

std::vector<WordPair> paired(const OverrideTable& table, const std::vector<std::uint32_t>& words) {
  std::vector<WordPair> pairs;
  for (std::size_t i = 0; i < std::min(words.size(), table.code.size()); ++i) {
    pairs.push_back({.sent = table.code[i], .seen = words[i]});
  }
  return pairs;
}

}  // namespace steadyrest::adapters::lines
