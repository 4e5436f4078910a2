// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <sstream>

#include "scratch.hpp"
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace steadyrest::test {
namespace {

namespace fs = std::filesystem;

/// 126 and 127 are codes that the program itself never returns.
void redirect(const char* path, int descriptor) {
  const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0 || dup2(file, descriptor) < 0) {
    _exit(126);
  }
}

bool redirect_stdin(const std::string& path) {
  if (path.empty()) {
    return true;
  }
  const int file = open(path.c_str(), O_RDONLY);
  return file >= 0 && dup2(file, STDIN_FILENO) >= 0;
}

Finished run_in(const std::vector<std::string>& arguments, const std::string& out_path,
                const std::string& in_path = "") {
  // The examples are in it, so that paths in commands are short.
  const Scratch folder;
  fs::create_symlink(fs::path(STEADYREST_SOURCE_DIR) / "examples", folder.path() / "examples");
  std::vector<char*> argv = {const_cast<char*>("steadyrest")};
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);
  const std::string out = out_path.empty() ? (folder.path() / ".out").string() : out_path;
  const std::string err = (folder.path() / ".err").string();
  const std::string at = folder.path().string();
  const pid_t child = fork();
  if (child == 0) {
    redirect(out.c_str(), STDOUT_FILENO);
    redirect(err.c_str(), STDERR_FILENO);
    if (redirect_stdin(in_path) && chdir(at.c_str()) == 0) {
      execv(STEADYREST_PROGRAM, argv.data());
    }
    _exit(127);
  }
  Finished finished;
  int status = 0;
  if (child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status)) {
    finished.code = WEXITSTATUS(status);
  }
  finished.out = out_path.empty() ? text_of_file(out) : "";
  finished.err = text_of_file(err);
  return finished;
}

}  // namespace

Finished run(const std::vector<std::string>& arguments) {
  return run_in(arguments, "");
}

std::vector<std::string> words(const std::string& line) {
  std::istringstream in(line);
  return {std::istream_iterator<std::string>(in), std::istream_iterator<std::string>()};
}

Finished run_line(const std::string& line) {
  return run(words(line));
}

Finished run_line_on(const std::string& line, const std::string& stdin_path) {
  return run_in(words(line), "", stdin_path);
}

Finished run_on_full_disk(const std::vector<std::string>& arguments) {
  return run_in(arguments, "/dev/full");
}

std::string project_file(const std::string& relative) {
  return (fs::path(STEADYREST_SOURCE_DIR) / relative).string();
}

}  // namespace steadyrest::test
