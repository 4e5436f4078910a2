// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "program.hpp"
#include "scratch.hpp"
#include <nlohmann/json.hpp>

/// A log in the spellings that other programs write.
namespace steadyrest::test {

using nlohmann::json;

/// A file line by line, changed by `line`.
template <class Line>
std::string changed(const std::string& file, const Line& line) {
  std::istringstream in(text_of_file(project_file(file)));
  std::string out;
  for (std::string one; std::getline(in, one);) {
    out += line(one);
  }
  return out;
}

inline bool is_comment(const std::string& line) {
  return line.find('#') == 0;
}

/// Only the rows, with this between the fields and this after them: a log without a header.
inline std::string rows_alone(const std::string& file, char separator, const std::string& end) {
  return changed(file, [&](const std::string& line) {
    std::string out;
    if (!is_comment(line) && line.find("t_s") != 0) {
      out = line + end;
      std::replace(out.begin(), out.end(), ',', separator);
    }
    return out;
  });
}

/// `;` between the fields, a decimal comma, CR LF and a byte order mark: what a spreadsheet writes
/// in half of Europe.
inline std::string continental(const std::string& file) {
  return "\xEF\xBB\xBF" + changed(file, [](const std::string& line) {
           std::string out = line + "\r\n";
           if (!is_comment(line)) {
             std::replace(out.begin(), out.end(), ',', ';');
             std::replace(out.begin(), out.end(), '.', ',');
           }
           return out;
         });
}

inline json without(json answer, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    answer.erase(key);
  }
  return answer;
}

}  // namespace steadyrest::test
