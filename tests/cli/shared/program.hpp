// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace steadyrest::test {

struct Finished {
  int code = -1;
  std::string out;
  std::string err;
};

/// Runs the built `steadyrest` in a fresh folder with the project's `examples`.
Finished run(const std::vector<std::string>& arguments);

/// Arguments as in a shell without quotes.
std::vector<std::string> words(const std::string& line);

/// The same, by a line of such words.
Finished run_line(const std::string& line);

/// The same, with this file on stdin.
Finished run_line_on(const std::string& line, const std::string& stdin_path);

/// Runs with stdout on /dev/full.
Finished run_on_full_disk(const std::vector<std::string>& arguments);

/// Path of a file in the project.
std::string project_file(const std::string& relative);

}  // namespace steadyrest::test
