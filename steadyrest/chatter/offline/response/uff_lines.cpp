// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include <steadyrest/chatter/offline/response/uff_lines.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::chatter::offline {

using kernel::outcome::Refusal;

bool is_universal(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of("\r\n"), text.size()));
  const std::string_view line = text.substr(0, text.find('\n'));
  const std::size_t begin = line.find_first_not_of(' ');
  return begin != std::string_view::npos && line.substr(begin, 2) == "-1" &&
         line.find_first_not_of(" \r", begin + 2) == std::string_view::npos;
}

std::string_view uff_trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \r\t");
  if (begin == std::string_view::npos) {
    return {};
  }
  return text.substr(begin, text.find_last_not_of(" \r\t") - begin + 1);
}

std::vector<std::string_view> uff_words(std::string_view line) {
  std::vector<std::string_view> out;
  for (line = uff_trimmed(line); !line.empty(); line = uff_trimmed(line)) {
    const std::size_t end = std::min(line.find_first_of(" \r\t"), line.size());
    out.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return out;
}

std::string_view uff_columns(std::string_view line, std::size_t at, std::size_t size) {
  return line.size() > at ? uff_trimmed(line.substr(at, size)) : std::string_view();
}

std::optional<double> uff_number(std::string_view word) {
  std::string text(word);
  std::ranges::replace(text, 'D', 'E');
  std::ranges::replace(text, 'd', 'E');
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != '\0' || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

std::optional<long> uff_whole(std::string_view word) {
  const auto value = uff_number(word);
  if (!value || std::abs(*value) > 1e9 || *value != std::floor(*value)) {
    return std::nullopt;
  }
  return static_cast<long>(*value);
}

bool UffLines::next() {
  if (rest_.empty()) {
    return false;
  }
  const std::size_t end = std::min(rest_.find('\n'), rest_.size());
  line_ = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  ++at_;
  return true;
}

bool UffLines::is_delimiter() const {
  return uff_trimmed(line_) == "-1";
}

bool UffLines::pass_over() {
  while (next()) {
    if (is_delimiter()) {
      return true;
    }
  }
  return false;
}

bool UffLines::ends_after(std::size_t count) const {
  if (count > rest_.size()) {
    return false;
  }
  // In columns 5 and 6: bytes that were lost in front of it do not pass for its blanks.
  constexpr std::string_view kEnd = "    -1";
  const std::string_view behind = rest_.substr(count);
  const std::size_t begin = std::min(behind.find_first_not_of("\r\n"), behind.size());
  const std::string_view line = behind.substr(begin, behind.find('\n', begin) - begin);
  return line.starts_with(kEnd) && uff_trimmed(line) == "-1";
}

std::string_view UffLines::bytes(std::size_t count) {
  const std::string_view out = rest_.substr(0, count);
  rest_.remove_prefix(count);
  return out;
}

Refusal UffLines::bad(std::string what, std::string to_do) const {
  return kernel::outcome::bad_input(file_, at_, std::move(what), std::move(to_do));
}

Refusal UffLines::truncated() const {
  return bad("the file ends within a dataset", "it is truncated; export it again");
}

}  // namespace steadyrest::chatter::offline
