// SPDX-License-Identifier: Apache-2.0
#include "output_folder.hpp"

#include <filesystem>
#include <fstream>

#include "program.hpp"

namespace steadyrest::test {
namespace {

namespace fs = std::filesystem;

Texts texts_of(const fs::path& folder, bool examples) {
  Texts out;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (!entry.is_directory() && name.starts_with("examples/") == examples) {
      out[name] = text_of_file(entry.path());
    }
  }
  return out;
}

/// The shortest part: these verbs run many times, and what they write counts, not what they cut.
constexpr const char* kGroove =
    "G21 G90 G94 G17\nG54\nT1 M6\nS2000 M3\nG0 X0 Y0 Z5\nG1 Z-1 F600\nX10\nG0 Z20\nM2\n";

}  // namespace

/// A copy of the examples, because tests make verbs overwrite them.
OutputFolder::OutputFolder(const OutputRow& row) : row_(row) {
  fs::copy(project_file("examples"), scratch_.at("examples"), fs::copy_options::recursive);
  scratch_.file("examples/groove.ngc", kGroove);
}

std::vector<std::string> OutputFolder::command(const Texts& instead) const {
  std::vector<std::string> out = words(row_.verb + " " + row_.arguments);
  for (const OutputOption& option : row_.outputs) {
    const auto other = instead.find(option.flag);
    out.push_back(option.flag);
    out.push_back(other == instead.end() ? option.value : other->second);
    if (option.flag == "--report") {  // the same bytes each time
      out.insert(out.end(), {"--report-date", "none"});
    }
  }
  return out;
}

std::vector<std::string> OutputFolder::outputs() const {
  std::vector<std::string> out;
  for (const OutputOption& option : row_.outputs) {
    out.insert(out.end(), option.files.begin(), option.files.end());
  }
  return out;
}

Texts OutputFolder::results() const {
  return texts_of(scratch_.at(""), false);
}

Texts OutputFolder::examples() const {
  return texts_of(scratch_.at(""), true);
}

/// Deletes everything but the examples, so that an earlier run's result cannot pass for this one's.
void OutputFolder::place(const Texts& results) const {
  for (const auto& entry : fs::directory_iterator(scratch_.at(""))) {
    if (entry.path().filename() != "examples") {
      fs::remove_all(entry.path());
    }
  }
  for (const auto& [name, text] : results) {
    fs::create_directories(fs::path(at(name)).parent_path());
    std::ofstream(at(name), std::ios::binary) << text;
  }
}

}  // namespace steadyrest::test
