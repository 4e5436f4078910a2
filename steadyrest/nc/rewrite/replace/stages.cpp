// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <expected>

#include <steadyrest/nc/rewrite/replace/stages.hpp>
#include <steadyrest/nc/rewrite/text/source_lines.hpp>

namespace steadyrest::nc::rewrite {

kernel::outcome::Result<Stage> with_lines(const std::string& program, const NewLines& lines) {
  auto source = SourceLines::open(program);
  if (!source) {
    return std::unexpected(source.error());
  }
  Stage stage{.text = {}, .origin = {0}};
  std::string usual = "\n";
  const auto put = [&](std::string_view text, std::string_view ending) {
    stage.text.append(text).append(ending);
    stage.origin.push_back(source->number());
  };
  while (source->next()) {
    const std::string ending(source->ending());
    usual = ending.empty() ? usual : ending;
    const auto found = lines.find(source->number());
    if (found == lines.end()) {
      put(source->line(), ending);
      continue;
    }
    const auto& texts = found->second;
    for (std::size_t i = 0; i < texts.size(); ++i) {
      put(texts[i], i + 1 == texts.size() ? ending : usual);
    }
  }
  if (auto whole = source->whole(); !whole) {
    return std::unexpected(whole.error());
  }
  return stage;
}

NewLines composed(const NewLines& first, const Stage& stage, const NewLines& second) {
  NewLines out = first;
  for (auto& [line, texts] : out) {
    texts.clear();
  }
  std::uint32_t before = 0;
  std::size_t of_line = 0;  // which of the new lines of its original line
  for (std::uint32_t number = 1; number < stage.origin.size(); ++number) {
    const std::uint32_t line = stage.origin[number];
    of_line = line == before ? of_line + 1 : 0;
    before = line;
    const auto own = first.find(line);
    const auto again = second.find(number);
    if (again != second.end()) {
      auto& texts = out[line];
      texts.insert(texts.end(), again->second.begin(), again->second.end());
    } else if (own != first.end()) {
      out[line].push_back(own->second[of_line]);
    }
  }
  return out;
}

}  // namespace steadyrest::nc::rewrite
